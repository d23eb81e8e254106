// SPDX-License-Identifier: Apache-2.0
// Edges of the scene's surfaces, and which of them a point sees as outlines.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::raytrace {

struct SceneEdge {
  Vec3 a{0.0}, b{0.0};
  // Unit normals of the triangles that share it; with one triangle, or more than two, the edge is
  // an outline from everywhere.
  Vec3 normal_a{0.0}, normal_b{0.0};
  bool is_border = true;

  // Seen from a point, or, with a distant one, from a direction.
  [[nodiscard]] bool is_outline(const Vec3& from, bool is_distant) const {
    if (is_border) return true;
    const Vec3 way = is_distant ? from : from - a;
    return glm::dot(way, normal_a) * glm::dot(way, normal_b) <= 0.0;
  }
};

// Without those between triangles of one plane.
[[nodiscard]] std::vector<SceneEdge> find_edges(const scenes::Scene& scene);

}  // namespace earthshine::raytrace
