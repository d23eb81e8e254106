// SPDX-License-Identifier: Apache-2.0
// Flat convex polygons in space: what the exact form factors are computed between.
#pragma once

#include <array>
#include <cassert>

#include "base/units.h"

namespace earthshine::radiosity {

// Corners run counter-clockwise about the unit normal; two of them may coincide (the cell at a
// triangle's apex). A quadrilateral cut by three planes has seven corners at most.
struct ConvexPolygon {
  static constexpr int most_corners = 8;
  std::array<Vec3, most_corners> corner{};
  int count = 0;
  Vec3 normal{0.0};

  void add(const Vec3& point) {
    assert(count < most_corners);
    corner[static_cast<std::size_t>(count++)] = point;
  }
  [[nodiscard]] const Vec3& operator[](int k) const { return corner[static_cast<std::size_t>(k)]; }
  // Corner k + 1, the first again after the last.
  [[nodiscard]] const Vec3& next(int k) const { return (*this)[k + 1 == count ? 0 : k + 1]; }
};

struct Plane {
  Vec3 point, normal;
  [[nodiscard]] double height(const Vec3& p) const { return glm::dot(normal, p - point); }
};

// A sphere about the polygon's middle that holds all corners.
struct Ball {
  Vec3 centre{0.0};
  double radius = 0.0;
};

[[nodiscard]] ConvexPolygon make_polygon(const std::array<Vec3, 4>& corners, const Vec3& normal);
[[nodiscard]] double area_m2(const ConvexPolygon& polygon);
[[nodiscard]] Ball ball_around(const ConvexPolygon& polygon);

// The part in front of the plane (height >= 0). Corners within `margin_m` of the plane count as on
// it; without a corner more than that in front, the result is empty.
[[nodiscard]] ConvexPolygon clip(const ConvexPolygon& polygon, const Plane& plane, double margin_m);

// Distance from a point to the polygon, m.
[[nodiscard]] double distance_m(const ConvexPolygon& polygon, const Vec3& point);

}  // namespace earthshine::radiosity
