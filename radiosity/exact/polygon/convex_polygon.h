// SPDX-License-Identifier: Apache-2.0
// Flat convex polygons in space, for the exact form factors.
#pragma once

#include <array>
#include <cassert>
#include <span>
#include <vector>

#include "base/numbers/gauss_rule.h"
#include "base/units.h"

namespace earthshine::radiosity {

// Corners are counter-clockwise about the unit normal; two may coincide (the cell at a triangle's
// apex). A quadrilateral cut by three planes has at most seven corners.
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
  // Corner k + 1; the first one follows the last.
  [[nodiscard]] const Vec3& next(int k) const { return (*this)[k + 1 == count ? 0 : k + 1]; }
};

struct Plane {
  Vec3 point, normal;
  [[nodiscard]] double height(const Vec3& p) const { return glm::dot(normal, p - point); }
};

// A sphere about the polygon's middle that contains all corners.
struct Ball {
  Vec3 centre{0.0};
  double radius = 0.0;
};

[[nodiscard]] ConvexPolygon make_polygon(const std::array<Vec3, 4>& corners, const Vec3& normal);
[[nodiscard]] double area_m2(const ConvexPolygon& polygon);
[[nodiscard]] Ball ball_around(const ConvexPolygon& polygon);

// The part in front of the plane (height >= 0). Corners within `margin_m` of the plane count as on
// it; the result is empty unless a corner is farther in front.
[[nodiscard]] ConvexPolygon clip(const ConvexPolygon& polygon, const Plane& plane, double margin_m);

// Distance from a point to the polygon, m.
[[nodiscard]] double distance_m(const ConvexPolygon& polygon, const Vec3& point);

// Gauss-Legendre rules on flat convex polygons.

struct AreaPoint {
  Vec3 position;
  double weight_m2;  // weights add up to the polygon's area
};

// points x points per quadrilateral of the polygon (a fan about its first corner).
void area_points(const ConvexPolygon& polygon, int points, std::vector<AreaPoint>& out);

// The same points by coordinates, padded to a multiple of four with points of weight 0.
struct PointView {
  const double *x, *y, *z, *weight_m2;
  std::size_t count;  // a multiple of 4
};
class PointColumns {
 public:
  void clear();
  // Appends points and returns the index of the first one.
  std::size_t add(const ConvexPolygon& polygon, int points);
  [[nodiscard]] std::size_t count() const { return x_.size(); }
  [[nodiscard]] PointView view(std::size_t first, std::size_t count) const {
    return {&x_[first], &y_[first], &z_[first], &weight_m2_[first], count};
  }
  [[nodiscard]] PointView view() const { return view(0, count()); }

 private:
  std::vector<double> x_, y_, z_, weight_m2_;
  std::vector<AreaPoint> scratch_;
};

}  // namespace earthshine::radiosity
