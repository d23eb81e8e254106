// SPDX-License-Identifier: Apache-2.0
// The side of each polygon on which its file's vertex normals lie, independent of winding.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

class FileFronts {
 public:
  // normal: of the polygon's plane, of any length, on the side of all of its corners' normals.
  void set(std::uint32_t polygon, const Vec3& normal) {
    if (polygon >= normals_.size()) normals_.resize(polygon + std::size_t{1}, glm::vec3(0.0F));
    normals_[polygon] = glm::vec3(glm::normalize(normal));
  }
  // For the scene's Triangle::polygon; 0: no normals in the file.
  [[nodiscard]] Vec3 of(std::uint32_t polygon) const {
    return polygon < normals_.size() ? Vec3(normals_[polygon]) : Vec3(0.0);
  }

 private:
  std::vector<glm::vec3> normals_;
};

}  // namespace earthshine::scenes
