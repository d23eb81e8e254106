// SPDX-License-Identifier: Apache-2.0
// Bounds of objects, and their intersections.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "scenes/triangle_point.h"

namespace earthshine::scenes {

struct Crossing {
  std::uint32_t a = 0, b = 0;  // objects, a < b
  std::size_t triangles = 0;   // triangles of both that cross triangles of the other
  double line_m = 0.0;         // length of the lines of intersection
};

// By pairs of objects, ascending. Triangles cross if each has corners on both sides of the other's
// plane and their intervals on the common line overlap (Möller, "A fast triangle-triangle
// intersection test", 1997). Touching and coplanar triangles do not cross. Lengths below 2e-6 of
// the scene's extent count as 0. Overlapping bodies with all faces in common planes have no such
// line; they are detected by points of one inside the other and points outside. After 50 million
// pairs of triangles, or 20 million solid angles, the search ends and `complete` is false.
struct Crossings {
  std::vector<Crossing> pairs;
  bool complete = true;
};
[[nodiscard]] Crossings find_crossings(const Scene& scene);

}  // namespace earthshine::scenes
