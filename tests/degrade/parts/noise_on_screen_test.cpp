// SPDX-License-Identifier: Apache-2.0
// Variance of the noise on another grid, against the direct double sum and sampled noise.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "degrade/moments/noise_moments.h"
#include "degrade/parts/monitor.h"
#include "degrade/parts/noise.h"
#include "tests/degrade/covariances.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::at;
using test::entry;
using test::flat;
using test::lopsided;
using test::matrix;
using test::ramp;

// The diagonal of W C W^T for results of any size, and the covariance of two results.
TEST(NoiseOnScreen, VariancesOnAnotherGridAreTheDirectDoubleSum) {
  const int columns = 7, rows = 6;
  const Covariance c = filtered(white(columns, rows, ramp(columns, rows)), lopsided(columns),
                                gaussian_blur(rows, 0.8));
  const PlaneMap a{spread_map(Spread::Sinc, 1.0, columns, 3),
                   spread_map(Spread::Sinc, 1.0, rows, 2)};
  const PlaneMap b{spread_map(Spread::Gaussian, 1.5, columns, 3),
                   spread_map(Spread::Triangle, 1.5, rows, 2)};
  const std::vector<double> ah = matrix(a.along), av = matrix(a.across), bh = matrix(b.along),
                            bv = matrix(b.across);
  const Plane variance = variance_after(c, a.along, a.across);
  const Plane between = covariance_between(c, a, b);
  const int wide = 3 * columns;
  ASSERT_EQ(variance.size(), static_cast<std::size_t>(wide * 2 * rows));
  for (int y = 0; y < 2 * rows; ++y) {
    for (int x = 0; x < wide; ++x) {
      double aa = 0.0, ab = 0.0;
      for (int q = 0; q < rows; ++q) {
        for (int p = 0; p < columns; ++p) {
          for (int t = 0; t < rows; ++t) {
            for (int s = 0; s < columns; ++s) {
              const double left = ah[at(p, x, columns)] * av[at(q, y, rows)] * entry(c, p, q, s, t);
              aa += left * ah[at(s, x, columns)] * av[at(t, y, rows)];
              ab += left * bh[at(s, x, columns)] * bv[at(t, y, rows)];
            }
          }
        }
      }
      ASSERT_NEAR(variance[at(x, y, wide)], aa, 2e-6) << x << ", " << y;
      ASSERT_NEAR(between[at(x, y, wide)], ab, 2e-6) << x << ", " << y;
    }
  }
}

// Sampled noise, blurred and spread on the finer grid of the screen. Over M distant pixels and N
// frames the mean of (sample square / predicted variance) is 1, with the standard error
// sqrt(2 / M N).
TEST(NoiseOnScreen, DrawnNoiseHasThePredictedVarianceOnTheScreen) {
  constexpr int columns = 40, rows = 30, frames = 250;
  const NoiseLaw law{0.04, 0.0, 0.0, false};
  const AxisMap along = gaussian_blur(columns, 0.6), across = gaussian_blur(rows, 0.35);
  const Covariance grain = filtered(white(columns, rows, Plane(1200, 0.04F)), along, across);
  for (const Spread spread : {Spread::Gaussian, Spread::Sinc}) {
    const AxisMap wide = spread_map(spread, 1.0, columns, 3),
                  high = spread_map(spread, 1.0, rows, 3);
    const Plane predicted = variance_after(grain, wide, high);
    double sum = 0.0, count = 0.0;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
      const Picture noise = add_read_noise(flat(columns, rows, 0.0F), law, {3, frame, 0});
      const Plane seen = apply(apply(noise, along, across), wide, high).planes.front();
      // Includes corners and edges.
      for (int y = 0; y < 3 * rows; y += 22) {
        for (int x = 0; x < 3 * columns; x += 17) {
          const std::size_t i = at(x, y, 3 * columns);
          sum += static_cast<double>(seen[i] * seen[i] / predicted[i]);
          count += 1.0;
        }
      }
    }
    EXPECT_NEAR(sum / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  }
}

TEST(NoiseOnScreen, SameBitsOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const base::ThreadLimit limit(threads);
    const Covariance c =
        filtered(white(70, 50, ramp(70, 50)), gaussian_blur(70, 0.7), gaussian_blur(50, 0.5));
    std::vector<Plane> all = c.planes;
    all.push_back(variance_after(c, spread_map(Spread::Gaussian, 1.0, 70, 3),
                                 spread_map(Spread::Gaussian, 1.0, 50, 3)));
    return all;
  };
  EXPECT_EQ(run(1), run(16));
}

}  // namespace
}  // namespace earthshine::degrade
