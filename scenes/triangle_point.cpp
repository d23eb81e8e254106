// SPDX-License-Identifier: Apache-2.0
#include "scenes/triangle_point.h"

#include <cmath>

namespace earthshine::scenes {

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

Barycentric barycentric(const Vec3& p, const Vec3& a, const Vec3& edge1, const Vec3& edge2) {
  const Vec3 normal = glm::cross(edge1, edge2), at = p - a;
  const double square = glm::dot(normal, normal);
  return {glm::dot(glm::cross(at, edge2), normal) / square,
          glm::dot(glm::cross(edge1, at), normal) / square};
}

glm::vec3 Box::middle_in_single() const { return {middle()}; }

Box box_around(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.add(point);
  return box;
}

double Corners::solid_angle() const {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  return 2.0 * std::atan2(triple_product(), la * lb * lc + glm::dot(a, b) * lc +
                                                glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

VertexRange vertices_of(const Scene& scene, const Object& object) {
  std::uint32_t low = ~0U, high = 0;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    for (const std::uint32_t v : scene.triangles[object.first_triangle + k].vertex) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  return high < low ? VertexRange() : VertexRange{low, high - low + 1};
}

Box bounds_of(const Scene& scene, const Object& object) {
  Box box;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const auto [a, b, c] = corners_of(scene, object.first_triangle + k);
    box.add(a), box.add(b), box.add(c);
  }
  return box;
}

}  // namespace earthshine::scenes
