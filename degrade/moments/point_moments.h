// SPDX-License-Identifier: Apache-2.0
// Mean, variance, slope and curvature of f(S) for a Gaussian signal S of mean mu and standard
// deviation sigma.
//   slope   E f'(S) = Cov(f(S), S) / sigma^2 (Stein 1981, Bussgang 1952): what f does to the
//           covariance of this signal with another, exactly if the two are jointly Gaussian and the
//           other stays linear, else to first order.
//   curvature  E f''(S) = E f(S) (z^2 - 1) / sigma^2, z = (S - mu) / sigma: the second order.
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

// min(max(S, low), high) in closed form; either limit may be infinite. The slope is the probability
// that S is between them, the curvature the density at low less that at high. With z = (high - mu)
// / sigma and low = -infinity:
//   E = mu P(z) + high (1 - P(z)) - sigma p(z),
//   E2 = (mu^2 + sigma^2) P(z) - sigma (mu + high) p(z) + high^2 (1 - P(z)).
[[nodiscard]] PointMoments clamped(double mean, double sigma, double low, double high);

// f(S) by quadrature, piece by piece between the kinks of f: mean, standard deviation, slope *
// sigma and curvature * sigma^2 within 2e-6 of the standard deviation of f(S) (or 1e-10 sigma,
// where next to nothing comes through). sigma = 0 gives f(mean), all else 0.
[[nodiscard]] PointMoments through(const PointMap& map, double mean, double sigma);

// The same for each pixel; variances below 0 (rounding) count as 0. Where many pixels are alike in
// mean and sigma the moments are interpolated in a table. With d the standard deviation of f(S) and
// r the rise of f from mean - 6 sigma to mean + 6 sigma, mean, slope * sigma and curvature *
// sigma^2 are then within 1e-4 d + 1e-5 r and the variance within 1e-4 d^2 + 1e-6 r^2. What is
// tabulated depends on the whole picture, so a part of it may differ by as much. Same bits on any
// number of threads.
struct MomentPlanes {
  Plane mean, variance, slope, curvature;
};
[[nodiscard]] MomentPlanes through(const PointMap& map, const Plane& mean, const Plane& variance);
// through(map, mean, variance).mean, for less.
[[nodiscard]] Plane mean_through(const PointMap& map, const Plane& mean, const Plane& variance);

}  // namespace earthshine::degrade
