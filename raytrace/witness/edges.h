// SPDX-License-Identifier: Apache-2.0
// Edges of the scene's surfaces, and their visibility as outlines.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::raytrace {

struct SceneEdge {
  Vec3 a{0.0}, b{0.0};
  // Unit normals of the triangles at the edge. With one triangle, or more than two, the edge is an
  // outline from everywhere.
  Vec3 normal_a{0.0}, normal_b{0.0};
  bool is_border = true;

  // Whether the edge is an outline from a point, or from a direction if is_distant.
  [[nodiscard]] bool is_outline(const Vec3& from, bool is_distant) const {
    if (is_border) return true;
    const Vec3 view = is_distant ? from : from - a;
    return glm::dot(view, normal_a) * glm::dot(view, normal_b) <= 0.0;
  }
};

// All edges but those between coplanar triangles.
[[nodiscard]] std::vector<SceneEdge> find_edges(const scenes::Scene& scene);

}  // namespace earthshine::raytrace
