// SPDX-License-Identifier: Apache-2.0
// Which side of a polygon its file's vertex normals are on, whatever way it is wound.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

class FileFronts {
 public:
  // normal: of the polygon's plane, of any length, on the side that the normals of all of its
  // corners are on.
  void set(std::uint32_t polygon, const Vec3& normal) {
    if (polygon >= normals_.size()) normals_.resize(polygon + std::size_t{1}, glm::vec3(0.0F));
    normals_[polygon] = glm::vec3(glm::normalize(normal));
  }
  // Of the scene's Triangle::polygon; 0: the file does not say.
  [[nodiscard]] Vec3 of(std::uint32_t polygon) const {
    return polygon < normals_.size() ? Vec3(normals_[polygon]) : Vec3(0.0);
  }

 private:
  std::vector<glm::vec3> normals_;
};

}  // namespace earthshine::scenes
