// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/triangle_point.h"
#include "scenes/view/motion.h"

namespace earthshine::raytrace {
namespace {

constexpr std::size_t ray_count = 96;
// Meshes with pinholes count as closed; half a body (winding number 0.5) does not.
constexpr double least_winding = 0.95;

bool back_is_black(const scenes::Material& material) {
  return !material.two_sided && base::max_component(material.transmit) <= 0.0;
}

// Fibonacci points: uniform on the sphere, and on no axis or diagonal, where edges often are.
Vec3 direction(std::size_t k) {
  const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / ray_count;
  const double phi = 2.0 * base::pi * static_cast<double>(k) / std::numbers::phi;
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

[[noreturn]] void refuse(const scenes::Scene& scene, const scenes::Camera& camera,
                         std::size_t object) {
  const std::string found = "camera \"" + camera.name + "\" is inside \"" +
                            scene.objects[object].name + "\" and sees the black backs of its faces";
  const char* allowed = "a one-sided surface is seen from its front";
  const char* remedy =
      "Move the camera out; or, if the object is a room, give it inward = true or a two_sided "
      "material";
  if (camera.where.file.empty()) {
    throw base::Error(base::Blame::Input, scene.path.string(), found, allowed, remedy);
  }
  throw base::Error(base::Blame::Input, camera.where, found, allowed, remedy);
}

}  // namespace

CameraModel make_camera_model(const scenes::Camera& camera, int columns, int rows) {
  CameraModel model;
  model.position = camera.position;
  model.forward = glm::normalize(camera.look_at - camera.position);
  model.right = glm::normalize(glm::cross(model.forward, camera.up));
  model.up = glm::cross(model.right, model.forward);
  model.projection = scenes::Projection(camera, columns, rows);
  model.columns = columns;
  model.rows = rows;
  const scenes::Shutter shutter(camera);
  model.motion = camera.motion;
  model.exposure_s = shutter.exposure_s;
  model.readout_s = shutter.readout_s;
  model.from_s = camera.open_from_s;
  model.until_s = camera.open_until_s;
  if (camera.aperture_m > 0.0 && camera.focus_m > 0.0) {
    model.focus_m = camera.focus_m;
    model.lens_radius_m = camera.aperture_m / 2;
  }
  return model;
}

CameraModel CameraModel::at(double t_s) const {
  CameraModel moved = *this;
  const scenes::MovedBy by(motion, position, t_s);
  moved.position = by.point(position);
  for (Vec3* axis : {&moved.forward, &moved.right, &moved.up}) *axis = by.direction(*axis);
  moved.motion = {};
  return moved;
}

CameraModel CameraModel::at_row(double y, double u) const {
  const double middle = ((std::floor(y) + 0.5) / rows - 0.5) * readout_s;
  const double begin = std::clamp(from_s, middle - 0.5 * exposure_s, middle + 0.5 * exposure_s);
  const double end = std::clamp(until_s, middle - 0.5 * exposure_s, middle + 0.5 * exposure_s);
  return at(begin + u * (end - begin));
}

Vec3 CameraModel::to_camera(const Vec3& point) const {
  const Vec3 offset = point - position;
  return {glm::dot(offset, right), -glm::dot(offset, up), glm::dot(offset, forward)};
}

double CameraModel::pixel_angle(const Vec3& direction) const {
  const double on_axis = 2.0 * projection.half_height / rows;
  if (!projection.is_distorted()) return on_axis;
  return on_axis / std::sqrt(projection.magnification(to_camera(position + direction)));
}

Ray CameraModel::ray(double x, double y, double lens_u, double lens_v) const {
  const double r = lens_radius_m * std::sqrt(lens_u), phi = 2.0 * base::pi * lens_v;
  const Vec3 on_lens =
      lens_radius_m > 0.0 ? position + r * (std::cos(phi) * right + std::sin(phi) * up) : position;
  return {on_lens, direction_from(on_lens, x, y)};
}

Vec3 CameraModel::direction_from(const Vec3& on_lens, double x, double y) const {
  const Vec3 in_camera = projection.direction({x / columns, y / rows});
  const Vec3 through = in_camera.z * forward + in_camera.x * right - in_camera.y * up;
  if (lens_radius_m <= 0.0) return glm::normalize(through);
  const Vec3 in_focus = position + focus_m * through;
  return glm::normalize(in_focus - on_lens);
}

glm::dvec2 CameraModel::film_from(const Vec3& on_lens, const Vec3& point) const {
  const glm::dvec2 place = projection.place(through_lens(on_lens, point));
  return {place.x * columns, place.y * rows};
}

// The direction in which the centre of the lens has the same place of the film.
Vec3 CameraModel::through_lens(const Vec3& on_lens, const Vec3& point) const {
  const Vec3 offset = to_camera(position + (point - on_lens));
  return lens_radius_m > 0.0 ? offset + offset.z / focus_m * to_camera(on_lens) : offset;
}

double CameraModel::film_per_m2(const Vec3& on_lens, const Vec3& point, const Vec3& normal) const {
  const Vec3 offset = point - on_lens;
  const double px2 = 0.25 * columns * rows / (projection.half_width * projection.half_height);
  const double depth = glm::dot(offset, forward), across = std::abs(glm::dot(offset, normal));
  if (lens_radius_m > 0.0) {
    return px2 * projection.magnification(through_lens(on_lens, point)) * across /
           (depth * depth * depth);
  }
  const double distance = glm::length(offset);
  return px2 * projection.film_per_sr(to_camera(point)) * across / (distance * distance * distance);
}

CameraMatrices camera_matrices(const CameraModel& camera) {
  CameraMatrices m;
  const scenes::Projection& p = camera.projection;
  const double fx = 0.5 * camera.columns / p.half_width, fy = 0.5 * camera.rows / p.half_height;
  const double cx = 0.5 * camera.columns - fx * p.middle.x,
               cy = 0.5 * camera.rows - fy * p.middle.y;
  m.k = {fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0};
  const Vec3 &x = camera.right, &z = camera.forward, &o = camera.position;
  const Vec3 down = -camera.up;
  m.to_world = {x.x, down.x, z.x, o.x, x.y, down.y, z.y, o.y,
                x.z, down.z, z.z, o.z, 0.0, 0.0,    0.0, 1.0};

  const Vec3& up = camera.up;
  const double ox = -glm::dot(o, x), oy = -glm::dot(o, up), oz = -glm::dot(o, z);
  m.world_to_camera = {x.x, up.x, z.x, 0.0, x.y, up.y, z.y, 0.0,
                       x.z, up.z, z.z, 0.0, ox,  oy,   oz,  1.0};
  // Each row times the projection: (fx x + cx z, cy z - fy y) by the picture's size, z - 1, over z.
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const in = &m.world_to_camera[4 * row];
    double* const out = &m.world_to_ndc[4 * row];
    out[0] = (fx * in[0] + cx * in[2]) / camera.columns;
    out[1] = (cy * in[2] - fy * in[1]) / camera.rows;
    out[2] = in[2] - in[3];
    out[3] = in[2];
  }
  m.screen_window_width = 2.0 * p.half_width;
  return m;
}

double winding_number(const scenes::Scene& scene, std::uint32_t object, const Vec3& point) {
  const scenes::Object& body = scene.objects[object];
  double sum = 0.0;
  for (std::uint32_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t) {
    if (!back_is_black(scene.materials[scene.triangles[t].material])) continue;
    sum += scenes::corners_of(scene, t).seen_from(point).solid_angle();
  }
  return sum / (4.0 * base::pi);
}

void check_camera(const scenes::Scene& scene, const scenes::RayQuery& query,
                  const scenes::Camera& camera) {
  std::vector<std::size_t> backs(scene.objects.size(), 0);
  std::size_t all_backs = 0;
  scenes::RayPacket rays;
  scenes::HitPacket hits;
  static_assert(ray_count % scenes::RayPacket::width == 0);
  for (std::size_t first = 0; first < ray_count; first += scenes::RayPacket::width) {
    for (std::size_t k = 0; k < scenes::RayPacket::width; ++k) {
      query.set(rays, k, camera.position, direction(first + k));
    }
    query.closest(rays, scenes::RayPacket::width, hits);
    for (std::size_t k = 0; k < scenes::RayPacket::width; ++k) {
      if (hits.triangle[k] == scenes::no_triangle || hits.front[k] != 0) continue;
      const scenes::Triangle& triangle = scene.triangles[hits.triangle[k]];
      if (!back_is_black(scene.materials[triangle.material])) continue;
      ++backs[triangle.object];
      ++all_backs;
    }
  }
  if (all_backs == 0) return;
  const auto most = std::max_element(backs.begin(), backs.end());
  const auto object = static_cast<std::size_t>(most - backs.begin());
  const bool encloses =
      2 * *most >= ray_count &&
      winding_number(scene, static_cast<std::uint32_t>(object), camera.position) >= least_winding;
  if (encloses || all_backs == ray_count) refuse(scene, camera, object);
}

}  // namespace earthshine::raytrace
