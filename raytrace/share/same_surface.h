// SPDX-License-Identifier: Apache-2.0
// Whether two points seen through nearby pixels lie on the same surface, flat or gently curved.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace earthshine::raytrace {

// Normals within 25 degrees, and neither point further off the other's tangent plane than a circle
// bends away over such an angle. slack_m: what rounding may do.
[[nodiscard]] inline bool same_surface(const glm::vec3& from, const glm::vec3& normal,
                                       const glm::vec3& to, const glm::vec3& other_normal,
                                       float slack_m) {
  constexpr float least_cosine = 0.906F, bend = 0.22F;
  if (glm::dot(normal, other_normal) < least_cosine) return false;
  const glm::vec3 way = to - from;
  const float reach = bend * glm::length(way) + slack_m;
  return std::abs(glm::dot(way, normal)) <= reach && std::abs(glm::dot(way, other_normal)) <= reach;
}

}  // namespace earthshine::raytrace
