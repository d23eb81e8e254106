// SPDX-License-Identifier: Apache-2.0
// Triangles of a scene and points on them.
#pragma once

#include <limits>
#include <span>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Axis-aligned box; empty before a point is added.
struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  void add(const Vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  [[nodiscard]] bool meets(const Box& other) const {
    return glm::all(glm::lessThanEqual(low, other.high)) &&
           glm::all(glm::lessThanEqual(other.low, high));
  }
  [[nodiscard]] Vec3 middle() const { return 0.5 * (low + high); }
  // Not inlined: inlined, GCC 12 drops the rounding from double to float of two components that it
  // vectorises.
  [[nodiscard, gnu::noinline]] glm::vec3 middle_in_single() const;
  [[nodiscard]] double diagonal() const { return glm::length(high - low); }
};
[[nodiscard]] Box box_around(std::span<const Vec3> points);

struct Corners {
  Vec3 a, b, c;
  // Its length is twice the area.
  [[nodiscard]] Vec3 normal() const { return glm::cross(b - a, c - a); }
  [[nodiscard]] Corners seen_from(const Vec3& point) const {
    return {a - point, b - point, c - point};
  }
  // 6 times the volume between triangle and origin, positive if the origin is behind the front.
  [[nodiscard]] double triple_product() const { return glm::dot(a, glm::cross(b, c)); }
  // Solid angle from the origin, sr, with the sign of triple_product() (van Oosterom and Strackee,
  // "The solid angle of a plane triangle", 1983, equation 8).
  [[nodiscard]] double solid_angle() const;
};
[[nodiscard]] inline Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const auto& v = scene.triangles[triangle].vertex;
  return {scene.vertices[v[0]], scene.vertices[v[1]], scene.vertices[v[2]]};
}

// Nearest point of triangle a, b, c to p (Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// Barycentric coordinates of p's projection on the plane of a, a + edge1, a + edge2: the weights of
// the second and the third corner. The triangle must have area.
struct Barycentric {
  double u, v;
};
[[nodiscard]] Barycentric barycentric(const Vec3& p, const Vec3& a, const Vec3& edge1,
                                      const Vec3& edge2);

// An object's vertices are its own and follow one another.
struct VertexRange {
  std::uint32_t first = 0, count = 0;
};
[[nodiscard]] VertexRange vertices_of(const Scene& scene, const Object& object);
// Bounding box of the object's triangles.
[[nodiscard]] Box bounds_of(const Scene& scene, const Object& object);

}  // namespace earthshine::scenes
