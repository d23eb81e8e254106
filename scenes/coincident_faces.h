// SPDX-License-Identifier: Apache-2.0
// The face that a ray hits first among faces that lie on each other. Copies its data from the
// scene.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

class CoincidentFaces {
 public:
  CoincidentFaces() = default;
  explicit CoincidentFaces(const Scene& scene);  // from scene.coincident

  [[nodiscard]] bool empty() const { return faces_.empty(); }

  struct Met {
    std::uint32_t triangle;
    double u, v;  // weights of its second and third vertex
    bool front;
  };
  // Of the faces that overlap the hit triangle at a point, the one in front of all others for light
  // along `direction`. No value: the triangle itself.
  [[nodiscard]] std::optional<Met> first_met(std::uint32_t triangle, const Vec3& at,
                                             const Vec3& direction) const;

  // Whether another face lies on part of a triangle's front (or back).
  [[nodiscard]] bool is_covered(std::uint32_t triangle, bool front) const {
    return !empty() && number_[triangle] != none &&
           faces_[number_[triangle]].covered[front ? 0 : 1];
  }
  // Whether another face covers the point, which lies over that side.
  [[nodiscard]] bool covers(std::uint32_t triangle, bool front, const Vec3& at) const;

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  struct Face {
    std::uint32_t triangle;
    Vec3 corner{0.0}, edge1{0.0}, edge2{0.0}, normal{0.0};  // normal of any length
    bool covered[2] = {false, false};                       // front, back
    std::uint32_t first = 0, end = 0;                       // of others_
  };
  struct Other {
    std::uint32_t face;
    bool before;      // it lies on the front side
    bool hides_both;  // and this face lies on the other's front: no light gets in between
  };
  std::vector<std::uint32_t> number_;  // face of each triangle, or none
  std::vector<Face> faces_;
  std::vector<Other> others_;
};

}  // namespace earthshine::scenes
