// SPDX-License-Identifier: Apache-2.0
// Form factors between two flat polygons that see each other wholly.
//
//   exchange_m2 = A_1 F_12 = A_2 F_21 = 1/pi  integral over both of  cos_1 cos_2 / r^2  dA dA
//
// By distance R over size: far apart, a product of Gauss rules over both areas; nearer, Lambert's
// exact point-to-polygon formula at Gauss points of the smaller; near or touching, the double
// contour integral edge by edge. Area rules
// err by at most 2e-5 of F_12 where F_12 < 1e-3 and by 2e-6 of it elsewhere; contours by about
// 1e-11, absolute.
// What lies behind the other's plane is cut off first.
#pragma once

#include "base/units.h"
#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {

// Never negative, never NaN; exactly 0 for coplanar polygons and those that face away.
// margin_m: heights below it are rounding of the coordinates and count as 0. 1e-12 of the two
// polygons' extent is added to it.
[[nodiscard]] double exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second,
                                 double margin_m = 0.0);

// The pieces, for callers that know which one they need. The polygons must be in front of each
// other.
[[nodiscard]] double contour_exchange_m2(const ConvexPolygon& first, const ConvexPolygon& second);
[[nodiscard]] double lambert_exchange_m2(const ConvexPolygon& points_on,
                                         const ConvexPolygon& polygon, int points);
[[nodiscard]] double area_exchange_m2(const PointView& first, const Vec3& first_normal,
                                      const PointView& second, const Vec3& second_normal);

// Points per direction for area_exchange_m2 on both sides at a centre distance of `separation`
// times the sum of the two radii; 0 where it is too near for that.
[[nodiscard]] int area_order(double separation);

// The double line integral over two straight edges, of which the contour form of the form factor is
// a sum:  A_1 F_12 = 1/(2 pi) sum over edges e of 1, f of 2 of  (d_e . d_f) I(e, f),
//   I(e, f) = integral over e and f of ln |p - q| dp dq.

struct Segment {
  Vec3 start, direction;  // direction of unit length
  double length = 0.0;
};

// I(e, f). Parallel edges and edges whose lines meet have closed forms, shared edges and shared
// corners among them:
//   parallel, offset c:  second differences of G(u) = (u^2-c^2)/4 ln(u^2+c^2) + c u atan(u/c) -
//   3u^2/4
//   lines that meet:     ln r is homogeneous but for an added constant, so that by the divergence
//                        theorem 2 I = (integral over the border of the parameters) - |e| |f|
// For skew lines one integral is closed and the other by Gauss rules on pieces that shrink towards
// where the edges come close; error below about 1e-9 |e| |f|.
[[nodiscard]] double log_distance_integral(const Segment& e, const Segment& f);

}  // namespace earthshine::radiosity
