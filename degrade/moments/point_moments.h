// SPDX-License-Identifier: Apache-2.0
// Mean, variance, slope and curvature of f(S) for a Gaussian signal S with mean mu and standard
// deviation sigma.
//   slope      E f'(S) = Cov(f(S), S) / sigma^2 (Stein 1981, Bussgang 1952): factor on the
//              covariance of S with another signal. Exact if both are jointly Gaussian and the
//              other one stays linear, else of first order.
//   curvature  E f''(S) = E f(S) (z^2 - 1) / sigma^2, z = (S - mu) / sigma: second order.
#pragma once

#include "degrade/stage/picture.h"
#include "degrade/stage/point_map.h"

namespace earthshine::degrade {

struct PointMoments {
  double mean = 0.0;
  double variance = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

// Standard normal distribution function and density.
[[nodiscard]] double normal_probability(double z);
[[nodiscard]] double normal_density(double z);

// Moments of min(max(S, low), high) in closed form; the limits may be infinite. The slope is the
// probability that S is between them. The curvature is the density at low minus the density at
// high. With z = (high - mu) / sigma and low = -infinity:
//   E = mu P(z) + high (1 - P(z)) - sigma p(z),
//   E2 = (mu^2 + sigma^2) P(z) - sigma (mu + high) p(z) + high^2 (1 - P(z)).
[[nodiscard]] PointMoments clamped(double mean, double sigma, double low, double high);

// Moments of f(S) by quadrature between the kinks of f. Mean, standard deviation, slope * sigma and
// curvature * sigma^2 have errors below 2e-6 of the standard deviation of f(S), or below 1e-10
// sigma where f is nearly constant. sigma = 0 gives f(mean) and zeros.
[[nodiscard]] PointMoments through(const PointMap& map, double mean, double sigma);

// The same for each pixel; negative variances (rounding) count as 0. Where many pixels have similar
// mean and sigma, the moments are interpolated in a table. Let d be the standard deviation of f(S)
// and r the rise of f from mean - 6 sigma to mean + 6 sigma. The errors of mean, slope * sigma and
// curvature * sigma^2 are then below 1e-4 d + 1e-5 r, the error of the variance below
// 1e-4 d^2 + 1e-6 r^2. The table depends on the whole picture, so that a part of it alone may
// give results that differ by as much. Bitwise equal for any number of threads.
struct MomentPlanes {
  Plane mean, variance, slope, curvature;
};
[[nodiscard]] MomentPlanes through(const PointMap& map, const Plane& mean, const Plane& variance);
// through(map, mean, variance).mean, at lower cost.
[[nodiscard]] Plane mean_through(const PointMap& map, const Plane& mean, const Plane& variance);

}  // namespace earthshine::degrade
