// SPDX-License-Identifier: Apache-2.0
// Where objects are, and which run through one another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

// Around the object's triangles.
[[nodiscard]] Box bounds_of(const Scene& scene, const Object& object);

struct Crossing {
  std::uint32_t a = 0, b = 0;  // objects, a < b
  std::size_t triangles = 0;   // of both, that triangles of the other pass through
  double line_m = 0.0;         // length of the lines in which these meet
};

// By pairs of objects, ascending. Triangles cross where each has corners on both sides of the
// other's plane and the lines in which they meet overlap (Möller, "A fast triangle-triangle
// intersection test", 1997); to touch, or to lie in one plane, is not to cross. Lengths below 2e-6
// of the scene's extent are none. Bodies that share space
// with all faces in the same planes, and so have no such line, are found by points of one inside the
// other beside points outside. After 50 million pairs of triangles, or
// 20 million solid angles, `complete` is false and the rest is left out.
struct Crossings {
  std::vector<Crossing> pairs;
  bool complete = true;
};
[[nodiscard]] Crossings find_crossings(const Scene& scene);

}  // namespace earthshine::scenes
