// SPDX-License-Identifier: Apache-2.0
// Which of many boxes meet.
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

// Calls take(item, item) once for each two boxes of different labels that meet. Space is parted
// until few boxes are left or all of them have one label: where a mesh is alone it costs nothing
// more.
void join_boxes(std::vector<LabelledBox> boxes,
                const std::function<void(std::uint32_t, std::uint32_t)>& take);

}  // namespace earthshine::scenes
