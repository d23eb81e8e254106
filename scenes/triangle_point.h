// SPDX-License-Identifier: Apache-2.0
// Points on triangles.
#pragma once

#include "base/units.h"

namespace earthshine::scenes {

// The point of the triangle a, b, c that is nearest to p (Ericson, "Real-Time Collision Detection",
// 2005, 5.1.5).
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// Barycentric coordinates of p's foot on the plane of a, a + edge1, a + edge2: the weights of the
// second and the third corner. The triangle has area.
struct Barycentric {
  double u, v;
};
[[nodiscard]] Barycentric barycentric(const Vec3& p, const Vec3& a, const Vec3& edge1,
                                      const Vec3& edge2);

}  // namespace earthshine::scenes
