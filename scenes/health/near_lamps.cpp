// SPDX-License-Identifier: Apache-2.0
#include "scenes/health/near_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

constexpr double near_m = 0.01, near_share = 1e-3, rounding_m = 1e-9;

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

void name_near_lamps(Scene& scene) {
  if (scene.vertices.empty()) return;
  Vec3 low = scene.vertices.front(), high = low;
  for (const Vec3& vertex : scene.vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const double reach = std::min(near_m, near_share * glm::length(high - low));
  for (const Lamp& lamp : scene.lamps) {
    if (has_size(lamp)) continue;
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t object = 0;
    for (const Triangle& triangle : scene.triangles) {
      const Vec3 &a = scene.vertices[triangle.vertex[0]], &b = scene.vertices[triangle.vertex[1]],
                 &c = scene.vertices[triangle.vertex[2]];
      // Most triangles are farther than that along one axis.
      const Vec3 from = glm::min(a, glm::min(b, c)) - reach,
                 to = glm::max(a, glm::max(b, c)) + reach;
      if (glm::any(glm::lessThan(lamp.position, from)) ||
          glm::any(glm::greaterThan(lamp.position, to))) {
        continue;
      }
      const double distance =
          glm::length(nearest_on_triangle(lamp.position, a, b, c) - lamp.position);
      if (distance >= nearest) continue;
      nearest = distance;
      object = triangle.object;
    }
    if (nearest >= reach) continue;
    scene.warnings.push_back(fmt::format(
        "lamp {} is {:.2g} mm from the object {}: pictures may lack what the spot under it "
        "reflects, and not know it; move it some centimetres off, or give it a size",
        in_quotes(lamp.name), nearest < rounding_m ? 0.0 : 1000.0 * nearest,
        in_quotes(scene.objects[object].name)));
  }
}

}  // namespace earthshine::scenes
