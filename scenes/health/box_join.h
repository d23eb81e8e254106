// SPDX-License-Identifier: Apache-2.0
// Intersection join of many boxes.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace earthshine::scenes {

struct LabelledBox {
  glm::vec3 low, high;
  std::uint32_t label, item;
};

// Calls take(item, item) once for each intersecting pair of boxes with different labels. Divides
// space until few boxes are left or all have one label; a mesh far from others costs nothing more.
void join_boxes(std::vector<LabelledBox> boxes,
                const std::function<void(std::uint32_t, std::uint32_t)>& take);

}  // namespace earthshine::scenes
