// SPDX-License-Identifier: Apache-2.0
#include "scenes/triangle_point.h"

#include <gtest/gtest.h>

#include "base/numbers/random.h"

namespace earthshine::scenes {
namespace {

// No other point of the triangle is nearer.
TEST(NearestOnTriangle, NoPointIsNearer) {
  base::Rng rng(base::Key(1, base::Stream::Pixel, 3));
  const auto point = [&] { return Vec3(rng.next(), rng.next(), rng.next()); };
  for (int k = 0; k < 200; ++k) {
    const Vec3 a = point(), b = point(), c = point(), p = 3.0 * point() - 1.0;
    const Vec3 found = nearest_on_triangle(p, a, b, c);
    // It is in the triangle: its three areas add up to the triangle's.
    const auto area = [](const Vec3& x, const Vec3& y, const Vec3& z) {
      return glm::length(glm::cross(y - x, z - x));
    };
    EXPECT_NEAR(area(found, a, b) + area(found, b, c) + area(found, c, a), area(a, b, c), 1e-12);
    for (int n = 0; n < 200; ++n) {
      double s = rng.next(), t = rng.next();
      if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
      EXPECT_GE(glm::length(a + s * (b - a) + t * (c - a) - p), glm::length(found - p) - 1e-12);
    }
  }
}

// A point with weights (u, v), moved off the plane, has these weights.
TEST(Barycentric, AreTheWeightsOfAPointsFoot) {
  base::Rng rng(base::Key(1, base::Stream::Pixel, 4));
  const auto point = [&] { return Vec3(rng.next(), rng.next(), rng.next()); };
  for (int k = 0; k < 200; ++k) {
    const Vec3 a = point(), edge1 = point(), edge2 = point();
    const double u = 3.0 * rng.next() - 1.0, v = 3.0 * rng.next() - 1.0;
    const Vec3 off = (rng.next() - 0.5) * glm::normalize(glm::cross(edge1, edge2));
    const Barycentric found = barycentric(a + u * edge1 + v * edge2 + off, a, edge1, edge2);
    EXPECT_NEAR(found.u, u, 1e-8);
    EXPECT_NEAR(found.v, v, 1e-8);
  }
}

}  // namespace
}  // namespace earthshine::scenes
