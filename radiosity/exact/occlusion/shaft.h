// SPDX-License-Identifier: Apache-2.0
// What can stand between two polygons: the convex hull of both, as planes.
#pragma once

#include <array>

#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {

// The polygons must be in front of each other (heights >= 0 up to margin_m).
class Shaft {
 public:
  Shaft(const ConvexPolygon& first, const ConvexPolygon& second, double margin_m);

  // False if nothing of the blocker is between the two; conservative.
  [[nodiscard]] bool may_hide(const ConvexPolygon& blocker) const;

 private:
  void add_planes(const ConvexPolygon& from, const ConvexPolygon& to);

  std::array<Plane, static_cast<std::size_t>(2 * ConvexPolygon::most_corners)> outside_{};
  std::size_t count_ = 0;
  Vec3 low_, high_;
  double margin_m_;
};

}  // namespace earthshine::radiosity
