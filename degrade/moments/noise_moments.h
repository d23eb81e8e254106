// SPDX-License-Identifier: Apache-2.0
// Second moments of the noise of one plane, carried through the linear stages without drawing any
// noise. Blur makes neighbours alike (grain), so a variance per pixel is not enough: kept are
//   C_d(z) = Cov(n(z), n(z + d)),   z = (x, y), d = (dx, dy) in pixels
// for the offsets d that matter. C_(-d)(z + d) = C_d(z), so half a plane of offsets holds all.
// Exact up to the rounding of floats, mirrored borders included, unless a function says otherwise.
#pragma once

#include <vector>

#include "degrade/moments/point_moments.h"
#include "degrade/stage/axis_map.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// dy > 0, or dy = 0 and dx >= 0.
struct Offset {
  int dx = 0;
  int dy = 0;
  bool operator==(const Offset&) const = default;
};

// Every plane has columns x rows values, in the unit of the signal squared; those with z + d
// outside the picture are 0. offsets[0] is (0, 0): the variance.
struct Covariance {
  int columns = 0;
  int rows = 0;
  std::vector<Offset> offsets;
  std::vector<Plane> planes;

  [[nodiscard]] const Plane& variance() const { return planes.front(); }
};

// Noise of the given variances, each pixel on its own.
[[nodiscard]] Covariance white(int columns, int rows, Plane variance);

// After every row through `along` and every column through `across` (degrade::apply):
// C' = W C W^T, one axis at a time. Offsets whose largest |C_d| is below 1e-6 of the largest
// variance are dropped. Throws base::Error if a map changes the size of the picture.
[[nodiscard]] Covariance filtered(const Covariance& noise, const AxisMap& along,
                                  const AxisMap& across);

// After a gain g(z) that may differ from pixel to pixel: C_d(z) g(z) g(z + d).
[[nodiscard]] Covariance scaled(const Covariance& noise, const Plane& gain);

// After a curved map point by point, of which the moments are known
// (degrade/moments/point_moments.h): two jointly Gaussian signals of covariance C_d keep
//   slope(z) slope(z + d) C_d + curvature(z) curvature(z + d) C_d^2 / 2,
// the first two terms of Mehler's series (1866). The next terms go with the third power of their
// correlation; for a clamp in the middle of its noise they are below 4 % of the variance. shared:
// of two signals that have no more than this noise in common, as two frames have a fixed pattern.
// mapped: of one signal whose noise this is, with the variance from the moments; it holds all
// terms, so this stays a covariance.
[[nodiscard]] Covariance shared(const Covariance& noise, const MomentPlanes& moments);
[[nodiscard]] Covariance mapped(const Covariance& noise, const MomentPlanes& moments);

// Odd and even rows come from two fields: C_d with odd dy times `across_fields`, the correlation
// from one field to the next (0 without lag).
[[nodiscard]] Covariance weave(Covariance noise, double across_fields);

[[nodiscard]] Covariance times(Covariance noise, double factor);
// Of the sum of independent noises. Throws base::Error if they differ in size.
[[nodiscard]] Covariance plus(Covariance a, const Covariance& b);

// The variance of each pixel after apply(picture, along, across), whose size may be another:
// sum over z, d of w(z) w(z + d) C_d(z). Weights may be negative and need not sum to 1.
[[nodiscard]] Plane variance_after(const Covariance& noise, const AxisMap& along,
                                   const AxisMap& across);

// The covariance of two such results at each pixel: of apply(n, a.along, a.across) with
// apply(n, b.along, b.across). All four maps fit the picture, and the two results are of one size.
[[nodiscard]] Plane covariance_between(const Covariance& noise, const PlaneMap& a,
                                       const PlaneMap& b);

}  // namespace earthshine::degrade
