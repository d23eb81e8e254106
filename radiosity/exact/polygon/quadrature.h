// SPDX-License-Identifier: Apache-2.0
// Gauss-Legendre rules on flat convex polygons.
#pragma once

#include <span>
#include <vector>

#include "base/numbers/gauss_rule.h"
#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {

struct AreaPoint {
  Vec3 position;
  double weight_m2;  // weights add up to the polygon's area
};

// points x points per quadrilateral of the polygon (a fan about its first corner).
void area_points(const ConvexPolygon& polygon, int points, std::vector<AreaPoint>& out);

// The same as columns, four at a time: the last four are filled up with points of weight 0.
struct PointView {
  const double *x, *y, *z, *weight_m2;
  std::size_t count;  // a multiple of 4
};
class PointColumns {
 public:
  void clear();
  // Appends and returns the first of the new points.
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
