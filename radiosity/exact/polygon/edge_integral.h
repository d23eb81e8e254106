// SPDX-License-Identifier: Apache-2.0
// The double line integral over two straight edges, of which the contour form of the form factor is
// a sum:  A_1 F_12 = 1/(2 pi) sum over edges e of 1, f of 2 of  (d_e . d_f) I(e, f),
//   I(e, f) = integral over e and f of ln |p - q| dp dq.
#pragma once

#include "base/units.h"

namespace earthshine::radiosity {

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
