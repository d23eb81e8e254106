// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/triangle_point.h"

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
  model.half_height = std::tan(base::radians(camera.fov_deg / 2));
  model.half_width = model.half_height * columns / rows;
  model.columns = columns;
  model.rows = rows;
  if (camera.aperture_m > 0.0 && camera.focus_m > 0.0) {
    model.focus_m = camera.focus_m;
    model.lens_radius_m = camera.aperture_m / 2;
  }
  return model;
}

Ray CameraModel::ray(double x, double y, double lens_u, double lens_v) const {
  const double r = lens_radius_m * std::sqrt(lens_u), phi = 2.0 * base::pi * lens_v;
  const Vec3 on_lens =
      lens_radius_m > 0.0 ? position + r * (std::cos(phi) * right + std::sin(phi) * up) : position;
  return {on_lens, direction_from(on_lens, x, y)};
}

Vec3 CameraModel::direction_from(const Vec3& on_lens, double x, double y) const {
  const double sx = (2.0 * x / columns - 1.0) * half_width;
  const double sy = (1.0 - 2.0 * y / rows) * half_height;
  const Vec3 through = forward + sx * right + sy * up;
  if (lens_radius_m <= 0.0) return glm::normalize(through);
  const Vec3 in_focus = position + focus_m * through;
  return glm::normalize(in_focus - on_lens);
}

glm::dvec2 CameraModel::film_from(const Vec3& on_lens, const Vec3& point) const {
  const Vec3 way = point - on_lens, off = on_lens - position;
  const double depth = glm::dot(way, forward), focus = lens_radius_m > 0.0 ? focus_m : 1.0;
  const double sx = glm::dot(off, right) / focus + glm::dot(way, right) / depth;
  const double sy = glm::dot(off, up) / focus + glm::dot(way, up) / depth;
  return {0.5 * (sx / half_width + 1.0) * columns, 0.5 * (1.0 - sy / half_height) * rows};
}

double CameraModel::film_per_m2(const Vec3& on_lens, const Vec3& point, const Vec3& normal) const {
  // A solid angle over the cube of its cosine to the axis is its area at unit distance.
  const Vec3 way = point - on_lens;
  const double depth = glm::dot(way, forward), px = 0.5 * columns / half_width;
  return px * px * std::abs(glm::dot(way, normal)) / (depth * depth * depth);
}

CameraMatrices camera_matrices(const CameraModel& camera) {
  CameraMatrices m;
  const double columns = camera.columns, rows = camera.rows;
  m.k = {columns / (2.0 * camera.half_width),
         0.0,
         columns / 2.0,
         0.0,
         rows / (2.0 * camera.half_height),
         rows / 2.0,
         0.0,
         0.0,
         1.0};
  const Vec3 &x = camera.right, &z = camera.forward, &o = camera.position;
  const Vec3 down = -camera.up;
  m.to_world = {x.x, down.x, z.x, o.x, x.y, down.y, z.y, o.y,
                x.z, down.z, z.z, o.z, 0.0, 0.0,    0.0, 1.0};

  const Vec3& up = camera.up;
  const double ox = -glm::dot(o, x), oy = -glm::dot(o, up), oz = -glm::dot(o, z);
  m.world_to_camera = {x.x, up.x, z.x, 0.0, x.y, up.y, z.y, 0.0,
                       x.z, up.z, z.z, 0.0, ox,  oy,   oz,  1.0};
  // Each row times the projection: u = x / (2 w) + z / 2, v = z / 2 - y / (2 h), z - 1, over z.
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const in = &m.world_to_camera[4 * row];
    double* const out = &m.world_to_ndc[4 * row];
    out[0] = in[0] / (2.0 * camera.half_width) + in[2] / 2.0;
    out[1] = in[2] / 2.0 - in[1] / (2.0 * camera.half_height);
    out[2] = in[2] - in[3];
    out[3] = in[2];
  }
  m.screen_window_width = 2.0 * camera.half_width;
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
