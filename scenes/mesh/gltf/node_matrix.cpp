// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scenes/mesh/gltf/model.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {

glm::dmat4 node_matrix(const GltfNode& node, const std::filesystem::path& path) {
  const auto check = [&](const std::vector<double>& values, std::size_t wanted,
                         std::string_view what) {
    const bool finite = std::all_of(values.begin(), values.end(),
                                    [](double x) { return std::abs(x) <= largest_coordinate; });
    if ((values.empty() || values.size() == wanted) && finite) return;
    gltf_fail(path, fmt::format("the {} of node {}", what, in_quotes(node.name)),
              fmt::format("it has {} finite numbers", wanted));
  };
  check(node.matrix, 16, "matrix");
  check(node.translation, 3, "translation");
  check(node.rotation, 4, "rotation");
  check(node.scale, 3, "scale");
  glm::dmat4 matrix(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (!node.translation.empty()) {
    matrix =
        glm::translate(matrix, Vec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (!node.rotation.empty()) {
    const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(turn) > 1e-9)) {
      gltf_fail(path, fmt::format("the rotation of node {} has no length", in_quotes(node.name)));
    }
    matrix = matrix * glm::mat4_cast(glm::normalize(turn));
  }
  if (!node.scale.empty()) {
    matrix = glm::scale(matrix, Vec3(node.scale[0], node.scale[1], node.scale[2]));
  }
  return matrix;
}

}  // namespace earthshine::scenes
