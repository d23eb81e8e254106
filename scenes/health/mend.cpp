// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "scenes/health/doubled_faces.h"
#include "scenes/health/orienter.h"
#include "scenes/health/topology.h"
#include "scenes/light/lamp_light.h"
#include "scenes/ray_query.h"
#include "scenes/surface_offset.h"
#include "scenes/text/message_text.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

// Distance of a lamp from a surface in contact distances (surface_offset.h): the minimum, and the
// distance below which it lies on the surface.
constexpr double least_contacts = 8.0, rounding_contacts = 1e-6;
constexpr int most_lifts = 8;

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();
  Vec3 point{0.0};
  std::uint32_t triangle = 0;
  double reach_m = 0.0;  // minimum distance of a lamp from that triangle
  bool on_it = false;
  [[nodiscard]] bool found() const { return distance_m < reach_m; }
};

// The nearest point of the surfaces that are closer than a lamp may be, if any.
Nearest nearest_surface(const Scene& scene, const SurfaceOffsets& offsets, const Vec3& position) {
  constexpr double rounding = 1e-6;  // of a lamp that was moved off the surface
  Nearest nearest;
  for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
    const auto [a, b, c] = corners_of(scene, k);
    const double reach = least_contacts * offsets.contact(k);
    // Most triangles are farther away along one axis.
    const Vec3 from = glm::min(a, glm::min(b, c)) - reach, to = glm::max(a, glm::max(b, c)) + reach;
    if (glm::any(glm::lessThan(position, from)) || glm::any(glm::greaterThan(position, to))) {
      continue;
    }
    const Vec3 point = nearest_on_triangle(position, a, b, c);
    const double distance = glm::length(point - position);
    if (distance < std::min(nearest.distance_m, reach * (1.0 - rounding))) {
      nearest = {distance, point, k, reach, distance < rounding_contacts * offsets.contact(k)};
    }
  }
  return nearest;
}

// Whether the lamp would cross a surface that it is near.
bool goes_through(const Scene& scene, const Vec3& from, const Vec3& to, double reach) {
  for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
    const auto [a, b, c] = corners_of(scene, k);
    const Vec3 normal = triangle_normal(scene, k);
    if (glm::dot(from - a, normal) * glm::dot(to - a, normal) >= 0.0) continue;
    if (glm::length(nearest_on_triangle(from, a, b, c) - from) < reach) return true;
  }
  return false;
}

// Moves off several surfaces in turn, as in a corner; no value if this does not end.
std::optional<Vec3> lifted(const Scene& scene, const SurfaceOffsets& offsets, const Vec3& start) {
  Vec3 position = start;
  double most_m = 0.0;
  for (int k = 0; k < most_lifts; ++k) {
    const Nearest near = nearest_surface(scene, offsets, position);
    if (!near.found()) {
      if (goes_through(scene, start, position, most_m)) return std::nullopt;
      return position;
    }
    const Vec3 away = near.on_it ? triangle_normal(scene, near.triangle)
                                 : (position - near.point) / near.distance_m;
    position = near.point + near.reach_m * away;
    most_m = std::max(most_m, near.reach_m);
  }
  return std::nullopt;
}

// Flush-mounted lamps with a front, which shine away from their surface, lose no light, but camera
// rays must hit them first.
bool shines_at(const Scene& scene, const Lamp& lamp, const Nearest& near) {
  const Vec3 toward =
      near.on_it ? -triangle_normal(scene, near.triangle) : near.point - lamp.position;
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
    // Bodies first: if one that is inside out touches another, their faces have equal normals.
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
  if (scene.lamps.empty()) return;
  const SurfaceOffsets offsets(scene);
  for (Lamp& lamp : scene.lamps) {
    if (lamp.is_distant()) continue;
    const Nearest first = nearest_surface(scene, offsets, lamp.position);
    if (!first.found()) continue;
    if (is_wide(lamp.kind) && !shines_at(scene, lamp, first)) {
      const Vec3 free = lamp.position + (first.reach_m - first.distance_m) * lamp.axis;
      if (!goes_through(scene, lamp.position, free, first.reach_m)) lamp.position = free;
      continue;
    }
    const std::string name = in_quotes(lamp.name),
                      object =
                          in_quotes(scene.objects[scene.triangles[first.triangle].object].name);
    const std::optional<Vec3> free = lifted(scene, offsets, lamp.position);
    if (!free) {
      scene.warnings.push_back(
          fmt::format("lamp {} stands between surfaces of the object {} and others that are less "
                      "than {:.2g} mm apart: single precision cannot resolve where its light goes; "
                      "move it",
                      name, object, 2000.0 * first.reach_m));
      continue;
    }
    const std::string where =
        first.on_it ? "on" : fmt::format("{:.2g} mm from", 1000.0 * first.distance_m);
    scene.warnings.push_back(
        fmt::format("lamp {} is {} the object {}, nearer than single precision resolves: taken "
                    "to be {:.2g} mm {}",
                    name, where, object, 1000.0 * glm::length(*free - lamp.position),
                    first.on_it ? "in front of it" : "farther off"));
    lamp.position = *free;
  }
}

}  // namespace earthshine::scenes
