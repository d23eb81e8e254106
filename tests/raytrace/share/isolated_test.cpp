// SPDX-License-Identifier: Apache-2.0
// Isolated gather points, and their noise from the halves of their rounds.
#include "raytrace/share/isolated.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "tests/raytrace/share/flat_estimate.h"

namespace earthshine::raytrace {
namespace {

using flat_estimate::count;
using flat_estimate::edge_px;
using flat_estimate::estimate_of;
using flat_estimate::flat;
using flat_estimate::pixel;
using flat_estimate::window;

// Points on a plane, and one behind it, in the middle.
std::vector<GatherPoint> with_one_behind() {
  std::vector<GatherPoint> points = flat();
  points[pixel(20, 20)].position.z = -9.0F;
  return points;
}

// Three rounds of 8, 8 and 32 samples, each sample of variance 12 / 12 and mean 3: the mean of 48
// has the variance 1 / 48. Half differences are nearly normal; the variance of their sum of squares
// is
//   2 (8 + 8 + 32)^-2 (8^2 + 8^2 + 32^2) = 1
// of its squared mean, half of the value for a single difference: 2.
TEST(IsolatedPoints, NoiseOfAMeanIsToldByAllOfItsRounds) {
  constexpr int fields = 20000;
  base::Rng rng(base::Key(1, base::Stream::Test, 51));
  double mean = 0.0, squared = 0.0;
  for (int field = 0; field < fields; ++field) {
    Estimate estimate(1, 1, 1);
    for (const int half : {4, 4, 16}) {
      const auto of_half = [&] {
        double sum = 0.0;
        for (int k = 0; k < half; ++k) sum += 3.0 + std::sqrt(12.0) * (rng.next() - 0.5);
        return static_cast<float>(sum);
      };
      const float first = of_half(), second = of_half();
      estimate.add_luminance(0, first, second);
      estimate.samples[0] += 2.0F * float(half);
    }
    const double relative = double(estimate.noise(0)) * 48.0;
    mean += relative / fields;
    squared += relative * relative / fields;
  }
  EXPECT_NEAR(mean, 1.0, 4.0 / std::sqrt(fields));
  EXPECT_LT(squared - mean * mean, 1.5);
}

// All other points of the 8 x 8 pixels have halves that differ by 2, noise 1 from two samples; the
// isolated point's halves agree.
TEST(IsolatedPoints, LikelyNoiseIsHalfThatOfThoseAround) {
  const Neighbours neighbours(window, with_one_behind());
  const Estimate estimate = estimate_of(
      [](int x, int y, std::size_t half) { return x == 20 && y == 20 ? 5.0 : 2.0 * double(half); });
  Shared shared = share(neighbours, estimate);
  regularise_isolated_variance(neighbours, window, {}, estimate, shared);
  EXPECT_TRUE(neighbours.is_alone(pixel(20, 20)));
  EXPECT_EQ(shared.squared_error[pixel(20, 20)], 0.0F);
  EXPECT_NEAR(double(shared.variance_prior[pixel(20, 20)]), 0.5 * 63.0 / 64.0, 1e-6);
  for (std::size_t p = 0; p < count; ++p) {
    if (p == pixel(20, 20)) continue;
    ASSERT_EQ(shared.variance_prior[p], 0.0F);
  }
}

// Noisy points have more samples: the predicted noise adds up to the stated noise.
TEST(IsolatedPoints, LikelyNoiseLeavesTheSumAsItIs) {
  std::vector<GatherPoint> points = flat();
  for (std::size_t p = 0; p < count; ++p) points[p].position.z = -2.0F - 20.0F * float(p);
  const Neighbours neighbours(window, points);
  base::Rng rng(base::Key(1, base::Stream::Test, 52));
  Estimate estimate = estimate_of([&](int, int, std::size_t) { return rng.next(); });
  for (std::size_t p = 0; p < count; ++p) {
    estimate.samples[p] = p % 3 == 0 ? 32.0F : 2.0F;
  }
  Shared shared = share(neighbours, estimate);
  regularise_isolated_variance(neighbours, window, {}, estimate, shared);
  double more = 0.0, size = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    more += double(shared.variance_prior[p]), size += std::abs(double(shared.variance_prior[p]));
  }
  EXPECT_GT(size, 0.0);
  EXPECT_NEAR(more / size, 0.0, 1e-5);
}

// Off-grid points are isolated without a base and without mirror neighbours. All off-grid points
// here have halves 0 and 1, noise 1/4 from two samples; the grid has no noise. Four on one pixel:
// of the region's 64 + 4 points, these have noise.
TEST(IsolatedPoints, StraysStandAloneWithoutAPointOfTheGridOrPeers) {
  const Neighbours neighbours(window, flat());
  const auto there = static_cast<std::uint32_t>(pixel(20, 20));
  const std::uint32_t region = region_of(there, edge_px);
  const std::vector<OffGridPoint> off_grid_points = {{there, no_base, region, 0.5F},
                                                     {there, there, region, 0.5F},
                                                     {there, no_base, region, 0.5F},
                                                     {there, no_base, region, 0.5F}};
  Estimate estimate(count + off_grid_points.size(), 1, 1);
  for (std::size_t p = 0; p < count + off_grid_points.size(); ++p) {
    estimate.add_luminance(p, p < count ? 1.0F : 0.0F, 1.0F);
    estimate.samples[p] = 2.0F;
  }
  Shared shared = share(neighbours, estimate);
  add_off_grid_points(off_grid_points, estimate, shared);
  shared.inverse_dof[0][count + 2] = shared.inverse_dof[0][count + 3] =
      0.5F;  // the value for mirror neighbours
  regularise_isolated_variance(neighbours, window, off_grid_points, estimate, shared);
  EXPECT_NEAR(double(shared.variance_prior[count]), 0.5 * (4.0 / 68.0 - 1.0) / 4.0, 1e-6);
  for (std::size_t k = 1; k < off_grid_points.size(); ++k)
    EXPECT_EQ(shared.variance_prior[count + k], 0.0F);
}

// Relative standard deviation over points far from the border.
double spread(const std::vector<double>& values) {
  double inner = 0.0, all = 0.0, squared = 0.0;
  for (int y = 16; y < edge_px - 16; ++y) {
    for (int x = 16; x < edge_px - 16; ++x) {
      inner += 1.0, all += values[pixel(x, y)], squared += std::pow(values[pixel(x, y)], 2);
    }
  }
  const double mean = all / inner;
  return std::sqrt(squared / inner - mean * mean) / mean;
}

// Signs depend on the samples, so that the cancellation of neighbours' noise is random. For a plane
// with noise only, the stated error in the mean of 100 fields varies over the points by about a
// tenth of its variation in one field (0.16). With fixed signs a part would remain.
TEST(IsolatedPoints, NoiseIsToldByOtherSignsForOtherSamples) {
  constexpr int fields = 100;
  const Neighbours neighbours(window, flat());
  std::vector<double> mean(count, 0.0);
  double of_one = 0.0;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    base::Rng rng(base::Key(seed, base::Stream::Test, 53));
    const Shared shared =
        share(neighbours, estimate_of([&](int, int, std::size_t) { return rng.next(); }));
    const std::vector<double> noise(shared.noise[1].begin(), shared.noise[1].end());
    for (std::size_t p = 0; p < count; ++p) mean[p] += noise[p] / fields;
    of_one += spread(noise) / fields;
  }
  EXPECT_LT(spread(mean), 0.2 * of_one);
}

}  // namespace
}  // namespace earthshine::raytrace
