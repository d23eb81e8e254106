// SPDX-License-Identifier: Apache-2.0
// Second moments of the noise of one plane, propagated through linear stages without random
// numbers. Blur correlates neighbours (grain), so that a variance per pixel is not enough. Stored
// are
//   C_d(z) = Cov(n(z), n(z + d)),   z = (x, y), d = (dx, dy) in pixels
// for the offsets d that matter. Half of the plane of offsets suffices, because
// C_(-d)(z + d) = C_d(z). Exact to float rounding, also at mirrored borders, unless stated
// otherwise.
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

// Every plane has columns x rows values, in squared units of the signal; 0 where z + d is outside
// the picture. offsets[0] is (0, 0): the variance.
struct Covariance {
  int columns = 0;
  int rows = 0;
  std::vector<Offset> offsets;
  std::vector<Plane> planes;

  [[nodiscard]] const Plane& variance() const { return planes.front(); }
};

// Noise of the given variances, independent between pixels.
[[nodiscard]] Covariance white(int columns, int rows, Plane variance);

// Covariance after every row passes `along` and every column passes `across` (degrade::apply):
// C' = W C W^T, one axis at a time. Drops offsets whose largest |C_d| is below 1e-6 of the largest
// variance. Throws base::Error if a map changes the size of the picture.
[[nodiscard]] Covariance filtered(const Covariance& noise, const AxisMap& along,
                                  const AxisMap& across);

// Covariance after a gain g(z) per pixel: C_d(z) g(z) g(z + d).
[[nodiscard]] Covariance scaled(const Covariance& noise, const Plane& gain);

// Covariance after a nonlinear point map with known moments (degrade/moments/point_moments.h). Two
// jointly Gaussian signals of covariance C_d then have the covariance
//   slope(z) slope(z + d) C_d + curvature(z) curvature(z + d) C_d^2 / 2,
// the first two terms of Mehler's series (1866). The remainder is of third order in the
// correlation; for a clamp at the mean of the noise it is below 4 % of the variance.
// shared: for two signals that have only this noise in common, such as the fixed pattern of two
// frames.
// mapped: for one signal with this noise. The variance is taken from the moments, which include all
// terms, so that the result is a valid covariance.
[[nodiscard]] Covariance shared(const Covariance& noise, const MomentPlanes& moments);
[[nodiscard]] Covariance mapped(const Covariance& noise, const MomentPlanes& moments);

// Interleaves the rows of two fields: C_d with odd dy is multiplied by `across_fields`, the
// correlation between consecutive fields (0 without lag).
[[nodiscard]] Covariance weave(Covariance noise, double across_fields);

[[nodiscard]] Covariance times(Covariance noise, double factor);
// Covariance of the sum of independent noises. Throws base::Error if they differ in size.
[[nodiscard]] Covariance plus(Covariance a, const Covariance& b);

// Variance of each pixel after apply(picture, along, across), which may change the size: sum over
// z, d of w(z) w(z + d) C_d(z). Weights may be negative and need not sum to 1.
[[nodiscard]] Plane variance_after(const Covariance& noise, const AxisMap& along,
                                   const AxisMap& across);

// Covariance at each pixel of apply(n, a.along, a.across) and apply(n, b.along, b.across). All maps
// fit the picture, and both results have the same size.
[[nodiscard]] Plane covariance_between(const Covariance& noise, const PlaneMap& a,
                                       const PlaneMap& b);

}  // namespace earthshine::degrade
