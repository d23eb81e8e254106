// SPDX-License-Identifier: Apache-2.0
// Form factors between two flat polygons without occlusion.
//
//   exchange_m2 = A_1 F_12 = A_2 F_21 = 1/pi  integral over both of  cos_1 cos_2 / r^2  dA dA
//
// The method depends on distance over size. Distant: a product of Gauss rules over both areas.
// Nearer: Lambert's exact point-to-polygon formula at Gauss points of the smaller polygon. Near or
// touching: the double contour integral by pairs of edges. The error of area rules is at most 2e-5
// of F_12 for F_12 < 1e-3 and 2e-6 of F_12 elsewhere; the error of contours is about 1e-11,
// absolute. Parts behind the other polygon's plane are cut off first.
#pragma once

#include "base/units.h"
#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {

// Never negative, never NaN; exactly 0 for coplanar polygons and those that face away. margin_m:
// heights below it are rounding errors of the coordinates and count as 0, increased by 1e-12 of the
// two polygons' extent.
[[nodiscard]] double exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second,
                                 double margin_m = 0.0);

// The single methods, for callers that select one. The polygons must be in front of each other.
[[nodiscard]] double contour_exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second);
[[nodiscard]] double lambert_exchange_m2(const ConvexPolygon& points_on,
                                         const ConvexPolygon& polygon, int points);
[[nodiscard]] double area_exchange_m2(const PointView& first, const Vec3& first_normal,
                                      const PointView& second, const Vec3& second_normal);

// Points per direction for area_exchange_m2 on both sides, for a centre distance of `separation`
// times the sum of the two radii; 0 if too near for area rules.
[[nodiscard]] int area_order(double separation);

// The double line integral over two straight edges; the contour form of the form factor is a sum of
// them:
//   A_1 F_12 = 1/(2 pi) sum over edges e of 1, f of 2 of  (d_e . d_f) I(e, f),
//   I(e, f) = integral over e and f of ln |p - q| dp dq.

struct Segment {
  Vec3 start, direction;  // direction of unit length
  double length = 0.0;
};

// I(e, f). Parallel edges and edges whose lines intersect have closed forms, including shared edges
// and shared corners:
//   parallel, offset c:  second differences of
//                        G(u) = (u^2-c^2)/4 ln(u^2+c^2) + c u atan(u/c) - 3u^2/4
//   intersecting lines:  ln r is homogeneous except for a constant; by the divergence theorem
//                        2 I = (integral over the border of the parameters) - |e| |f|
// For skew lines one integral is in closed form, the other by Gauss rules on intervals that become
// smaller toward the closest approach; error below about 1e-9 |e| |f|.
[[nodiscard]] double log_distance_integral(const Segment& e, const Segment& f);

}  // namespace earthshine::radiosity
