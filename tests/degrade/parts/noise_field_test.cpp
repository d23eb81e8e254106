// SPDX-License-Identifier: Apache-2.0
// The noise as a random field: neighbours, frames, planes, threads.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "degrade/parts/noise.h"
#include "degrade/stage/axis_map.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::correlation;
using test::flat;
using test::moments;

constexpr int edge = 256;
constexpr double count = 65'536.0;
constexpr NoiseLaw white{.a = 0.01};
constexpr NoiseLaw all{.a = 1e-4, .b = 1e-3, .c = 1e-3};

Plane field(const NoiseKey& key, std::size_t plane = 0) {
  return add_read_noise(flat(edge, edge, 0.5F, 3), white, key).planes[plane];
}

TEST(NoiseField, NeighboursAreUncorrelated) {
  const Plane noise = field({});
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      if (dx == 0 && dy == 0) continue;
      EXPECT_LT(std::abs(correlation(noise, noise, edge, edge, dx, dy)), 4.0 / std::sqrt(count))
          << dx << ", " << dy;
    }
  }
}

TEST(NoiseField, FramesViewsSeedsPlanesAndStagesAreUncorrelated) {
  const Plane first = field({1, 0, 0});
  const Picture shot = add_signal_noise(flat(edge, edge, 0.5F), {0.0, 0.0, 0.01, false}, {1, 0, 0});
  const Plane others[] = {field({2, 0, 0}), field({1, 1, 0}), field({1, 0, 1}), field({1, 0, 0}, 1),
                          shot.planes[0]};
  for (const Plane& other : others) {
    EXPECT_LT(std::abs(correlation(first, other, edge, edge, 0, 0)), 4.0 / std::sqrt(count));
  }
}

// With m values per tile, a tile's variance has the relative variance 2 / (m - 1). The sum over 16
// tiles of the squared standardised deviations is chi-squared with 16 degrees of freedom and the
// standard deviation sqrt(32).
TEST(NoiseField, IsTheSameStrengthEverywhere) {
  const Plane noise = field({3, 0, 0});
  double chi2 = 0.0;
  for (std::size_t tile = 0; tile < 16; ++tile) {
    Plane values;
    for (std::size_t i = 0; i < 64 * 64; ++i) {
      values.push_back(noise[(tile / 4 * 64 + i / 64) * edge + tile % 4 * 64 + i % 64]);
    }
    const double z = (moments(values).variance / white.a - 1.0) / std::sqrt(2.0 / 4095.0);
    chi2 += z * z;
  }
  EXPECT_NEAR(chi2, 16.0, 4.0 * std::sqrt(32.0));
}

TEST(NoiseField, SameBitsForOneTwoAndSixteenThreads) {
  const auto run = [](int threads) {
    const base::ThreadLimit limit(threads);
    const Picture in = flat(301, 77, 0.3F, 3);
    return add_read_noise(add_signal_noise(in, all, {5, 6, 7}), all, {5, 6, 7}).planes;
  };
  const auto one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(16));
}

TEST(NoiseField, PartOfThePictureHasThatPartOfTheNoise) {
  const Picture whole = add_read_noise(add_signal_noise(flat(90, 60, 0.3F), all, {}), all, {});
  const Picture part = add_read_noise(add_signal_noise(flat(31, 17, 0.3F), all, {}), all, {});
  for (std::size_t y = 0; y < 17; ++y) {
    for (std::size_t x = 0; x < 31; ++x) {
      ASSERT_EQ(part.planes[0][y * 31 + x], whole.planes[0][y * 90 + x]);
    }
  }
}

TEST(NoiseField, DifferingSensitivityIsTheSamePatternInEveryFrame) {
  const NoiseLaw pattern{.c = 0.01, .c_is_fixed_pattern = true}, grain{.c = 0.01};
  const auto frame = [](const NoiseLaw& law, std::uint64_t number) {
    return add_signal_noise(flat(20, 20, 0.5F), law, {1, number, 0}).planes[0];
  };
  EXPECT_EQ(frame(pattern, 0), frame(pattern, 9));
  EXPECT_NE(frame(grain, 0), frame(grain, 9));
}

// White noise through weights h along each axis: the variance is multiplied by (sum h^2)^2. For the
// discrete Gaussian sum h_n h_(n+k) = e^(-2t) I_k(2t), that is h with the variance 2t, so that the
// correlation of neighbours is I_1(2t) / I_0(2t). The sample variance of correlated noise has the
// relative variance (2 / M) (sum over lags of rho^2) per axis.
TEST(NoiseField, BlurAfterNoiseShrinksItAndMakesGrain) {
  for (const double sigma : {0.35, 0.7, 1.5}) {
    const std::vector<double> twice = discrete_gaussian(sigma * std::sqrt(2.0));
    const std::size_t middle = twice.size() / 2;
    const double h2 = twice[middle];
    double rho2 = 0.0;
    for (double value : twice) rho2 += value * value / (h2 * h2);
    const Picture noise = add_read_noise(flat(edge, edge, 0.0F), white, {});
    const AxisMap blur = gaussian_blur(edge, sigma);
    const Plane grain = apply(noise, blur, blur).planes[0];
    const double variance = white.a * h2 * h2;
    // The border has mirrored weights and up to twice the variance; the tolerance includes its
    // share.
    const double border = 4.0 * 2.0 * sigma / edge;
    EXPECT_NEAR(moments(grain).variance / variance, 1.0,
                4.0 * rho2 * std::sqrt(2.0 / count) + border)
        << sigma;
    EXPECT_NEAR(correlation(grain, grain, edge, edge, 1, 0), twice[middle + 1] / h2,
                4.0 * rho2 / std::sqrt(count) + border)
        << sigma;
  }
}

}  // namespace
}  // namespace earthshine::degrade
