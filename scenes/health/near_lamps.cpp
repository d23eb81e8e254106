// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/near_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenes/ray_query.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

// Of the surfaces' extent: four times what rays are lifted off surfaces (RayQuery), and what no
// scene means.
constexpr double least_lamp_share = 1.6e-5, rounding_share = 1e-12;

bool has_size(const Lamp& lamp) {
  return lamp.kind == LampKind::Rectangle || lamp.kind == LampKind::Disk;
}

}  // namespace

Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

namespace {

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();
  Vec3 point{0.0};
  std::uint32_t triangle = 0;
};

// The nearest point of the surfaces, if there is one within reach.
Nearest nearest_surface(const Scene& scene, const Vec3& position, double reach) {
  Nearest nearest;
  for (std::uint32_t k = 0; k < scene.triangles.size(); ++k) {
    const auto& vertex = scene.triangles[k].vertex;
    const Vec3 &a = scene.vertices[vertex[0]], &b = scene.vertices[vertex[1]],
               &c = scene.vertices[vertex[2]];
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

}  // namespace

void lift_lamps(Scene& scene) {
  if (scene.vertices.empty()) return;
  Vec3 low = scene.vertices.front(), high = low;
  for (const Vec3& vertex : scene.vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const double extent = glm::length(high - low), reach = least_lamp_share * extent;
  for (Lamp& lamp : scene.lamps) {
    if (has_size(lamp)) continue;
    const Nearest found = nearest_surface(scene, lamp.position, reach);
    if (found.distance_m >= reach) continue;
    const bool on_it = found.distance_m < rounding_share * extent;
    const Vec3 away = on_it ? triangle_normal(scene, found.triangle)
                            : (lamp.position - found.point) / found.distance_m;
    lamp.position = found.point + reach * away;
    const std::string where =
        on_it ? "on" : fmt::format("{:.2g} mm from", 1000.0 * found.distance_m);
    scene.warnings.push_back(
        fmt::format("lamp {} is {} the object {}, nearer than single precision tells apart: taken "
                    "to be {:.2g} mm {}",
                    in_quotes(lamp.name), where,
                    in_quotes(scene.objects[scene.triangles[found.triangle].object].name),
                    1000.0 * reach, on_it ? "in front of it" : "from it"));
  }
}

}  // namespace earthshine::scenes
