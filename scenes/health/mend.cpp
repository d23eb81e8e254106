// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/mend.h"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <utility>

#include "scenes/health/doubled_faces.h"
#include "scenes/health/orienter.h"
#include "scenes/health/topology.h"
#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Of the surfaces' extent: four times what rays are lifted off surfaces (RayQuery), and what no
// scene means.
constexpr double least_lamp_share = 1.6e-5, rounding_share = 1e-12;
constexpr int most_lifts = 8;

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();
  Vec3 point{0.0};
  std::uint32_t triangle = 0;
};

// The nearest point of the surfaces, if there is one within reach.
Nearest nearest_surface(const Scene& scene, const Vec3& position, double reach) {
  Nearest nearest;
  for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
    const auto [a, b, c] = corners_of(scene, k);
    // Most triangles are farther than that along one axis.
    const Vec3 from = glm::min(a, glm::min(b, c)) - reach, to = glm::max(a, glm::max(b, c)) + reach;
    if (glm::any(glm::lessThan(position, from)) || glm::any(glm::greaterThan(position, to))) {
      continue;
    }
    const Vec3 point = nearest_on_triangle(position, a, b, c);
    const double distance = glm::length(point - position);
    if (distance < nearest.distance_m) nearest = {distance, point, k};
  }
  return nearest;
}

// Whether the lamp would come to stand on the other side of a surface that it was near.
bool goes_through(const Scene& scene, const Vec3& from, const Vec3& to, double reach) {
  for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
    const auto [a, b, c] = corners_of(scene, k);
    const Vec3 normal = triangle_normal(scene, k);
    if (glm::dot(from - a, normal) * glm::dot(to - a, normal) >= 0.0) continue;
    if (glm::length(nearest_on_triangle(from, a, b, c) - from) < reach) return true;
  }
  return false;
}

// Off one surface after another, as many as meet in a corner; nothing if that has no end.
std::optional<Vec3> lifted(const Scene& scene, const Vec3& start, double extent) {
  Vec3 position = start;
  const double reach = least_lamp_share * extent;
  for (int k = 0; k < most_lifts; ++k) {
    const Nearest found = nearest_surface(scene, position, reach * (1.0 - 1e-6));
    if (found.distance_m >= reach * (1.0 - 1e-6)) {
      if (goes_through(scene, start, position, reach)) return std::nullopt;
      return position;
    }
    const bool on_it = found.distance_m < rounding_share * extent;
    const Vec3 away = on_it ? triangle_normal(scene, found.triangle)
                            : (position - found.point) / found.distance_m;
    position = found.point + reach * away;
  }
  return std::nullopt;
}

// Lamps with a front are often mounted flush: of those that shine away from what they stand on no
// light is lost, but rays from the camera must meet them first.
bool shines_at(const Scene& scene, const Lamp& lamp, const Nearest& found, bool on_it) {
  const Vec3 toward = on_it ? -triangle_normal(scene, found.triangle) : found.point - lamp.position;
  return glm::dot(toward, lamp.axis) > 0.0;
}

}  // namespace

FaceParts mend_surfaces(Scene& scene, const FileFronts& fronts) {
  Sheets sheets(scene);
  for (const Object& object : scene.objects) {
    if (object.orient != Orient::TwoSided) continue;
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
      Triangle& triangle = scene.triangles[object.first_triangle + t];
      triangle.material = sheets.of(triangle.material);
    }
  }
  const std::vector<std::uint32_t> ids = welded(scene.vertices);
  std::optional<Orienter> orienter(std::in_place, scene, ids, fronts);
  const DoubledFaces doubled = find_doubled_faces(scene, ids);
  if (!doubled.empty()) {
    // Bodies first: where one that is inside out touches another, their faces look alike.
    orienter->orient_all(true);
    if (mend_doubled_faces(scene, doubled, sheets, orienter->parts())) {
      orienter.emplace(scene, ids, fronts);
    }
  }
  orienter->orient_all(false);
  return orienter->parts();
}

void lift_lamps(Scene& scene) {
  if (scene.vertices.empty()) return;
  const double extent = box_around(scene.vertices).diagonal(), reach = least_lamp_share * extent;
  for (Lamp& lamp : scene.lamps) {
    const Nearest first = nearest_surface(scene, lamp.position, reach);
    if (first.distance_m >= reach) continue;
    const bool on_it = first.distance_m < rounding_share * extent;
    if (is_wide(lamp.kind) && !shines_at(scene, lamp, first, on_it)) {
      const Vec3 free = lamp.position + (reach - first.distance_m) * lamp.axis;
      if (!goes_through(scene, lamp.position, free, reach)) lamp.position = free;
      continue;
    }
    const std::string name = in_quotes(lamp.name),
                      object =
                          in_quotes(scene.objects[scene.triangles[first.triangle].object].name);
    const std::optional<Vec3> free = lifted(scene, lamp.position, extent);
    if (!free) {
      scene.warnings.push_back(
          fmt::format("lamp {} stands between surfaces of the object {} and others that are less "
                      "than {:.2g} mm apart: single precision cannot tell where its light goes; "
                      "move it",
                      name, object, 2000.0 * reach));
      continue;
    }
    const std::string where =
        on_it ? "on" : fmt::format("{:.2g} mm from", 1000.0 * first.distance_m);
    scene.warnings.push_back(
        fmt::format("lamp {} is {} the object {}, nearer than single precision tells apart: taken "
                    "to be {:.2g} mm {}",
                    name, where, object, 1000.0 * glm::length(*free - lamp.position),
                    on_it ? "in front of it" : "farther off"));
    lamp.position = *free;
  }
}

}  // namespace earthshine::scenes
