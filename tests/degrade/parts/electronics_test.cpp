// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/electronics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/units.h"
#include "degrade/parts/noise.h"
#include "degrade/stage/point_map.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;
using test::moments;

constexpr double count = 250'000.0;

double density(double z) { return std::exp(-z * z / 2.0) / std::sqrt(2.0 * base::pi); }
double distribution(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

Picture gaussian_field(float mean, double sigma) {
  return add_read_noise(flat(500, 500, mean), {.a = sigma * sigma}, {});
}

// min(X, W) of a Gaussian with z = (W - mu) / sigma: mean mu Phi + W (1 - Phi) - sigma phi, mean
// square (mu^2 + sigma^2) Phi - sigma (mu + W) phi + W^2 (1 - Phi), clipped share 1 - Phi.
TEST(WhiteClip, MomentsOfClippedNoiseAreTheirClosedForm) {
  constexpr double sigma = 0.1, limit = 1.1;
  for (const float mu : {0.9F, 1.05F, 1.2F}) {
    const double m = static_cast<double>(mu), z = (limit - m) / sigma;
    const double mean = m * distribution(z) + limit * (1.0 - distribution(z)) - sigma * density(z);
    const double square = (m * m + sigma * sigma) * distribution(z) -
                          sigma * (m + limit) * density(z) +
                          limit * limit * (1.0 - distribution(z));
    const Picture clipped = transform(gaussian_field(mu, sigma), PointMap().limit_above(limit));
    const auto found = moments(clipped.planes[0]);
    EXPECT_NEAR(found.mean, mean, 4.0 * std::sqrt((square - mean * mean) / count)) << mu;
    // The standard error of the variance is from the fourth moment of the sample.
    EXPECT_NEAR(found.variance, square - mean * mean,
                4.0 * std::sqrt((found.fourth - found.variance * found.variance) / count))
        << mu;
    double at_limit = 0.0;
    for (float value : clipped.planes[0])
      at_limit += value == static_cast<float>(limit) ? 1.0 : 0.0;
    const double share = 1.0 - distribution(z);
    EXPECT_NEAR(at_limit / count, share, 4.0 * std::sqrt(share * (1.0 - share) / count)) << mu;
  }
}

// max(X, 0) of a Gaussian about 0: mean sigma / sqrt(2 pi).
TEST(BlackClamp, HalfOfTheNoiseOfBlackBecomesBlack) {
  const Picture clamped = transform(gaussian_field(0.0F, 0.2), PointMap().limit_below(0.0));
  const auto found = moments(clamped.planes[0]);
  EXPECT_NEAR(found.mean, 0.2 * density(0.0), 4.0 * std::sqrt(found.variance / count));
  EXPECT_EQ(measure_levels(clamped, 0.0).crushed_share > 0.49, true);
}

TEST(Gain, ScalesSignalAndNoiseAndKeepsTheirRatio) {
  const Picture in = gaussian_field(0.5F, 0.05);
  const auto before = moments(in.planes[0]),
             after = moments(transform(in, PointMap().amplify(4.0)).planes[0]);
  EXPECT_NEAR(after.mean / std::sqrt(after.variance), before.mean / std::sqrt(before.variance),
              1e-6);
  EXPECT_NEAR(after.mean, 4.0 * before.mean, 1e-6);
}

Picture encode_gamma(Picture signal) {
  return transform(std::move(signal), PointMap().power(1.0 / 2.2));
}

TEST(Gamma, RoundTripIsTheIdentityAndNegativeIsBlackNotNan) {
  const Picture in{5, 1, {{-0.5F, 0.0F, 1e-6F, 0.3F, 1.1F}}};
  const Plane coded = encode_gamma(in).planes[0];
  EXPECT_EQ(coded[0], 0.0F);
  EXPECT_EQ(coded[1], 0.0F);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_NEAR(std::pow(coded[i], 2.2F), in.planes[0][i], 1e-6) << i;
    EXPECT_GT(coded[i], coded[i - 1] - (i == 1 ? 1.0F : 0.0F));
  }
}

// sigma_v = sigma S^(1/g - 1) / g: noise of the coded signal, for noise much smaller than the
// signal.
TEST(Gamma, LiftsTheNoiseOfShadowsAsItsSlopeSays) {
  for (const float s : {0.2F, 0.8F}) {
    const double sigma = 0.002;
    const auto coded = moments(encode_gamma(gaussian_field(s, sigma)).planes[0]);
    const double expected = sigma * std::pow(static_cast<double>(s), 1.0 / 2.2 - 1.0) / 2.2;
    EXPECT_NEAR(std::sqrt(coded.variance) / expected, 1.0, 4.0 / std::sqrt(2.0 * count) + 2e-4);
  }
}

// For a value uniform between two levels of distance q, the rounding error has the variance
// q^2 / 12 and no bias; truncation would have the bias -q/2. The ramp covers many levels uniformly;
// the standard error of the mean is q / sqrt(12 M).
TEST(Quantise, RoundsWithoutBiasAndAddsATwelfth) {
  constexpr int bits = 6;
  const double q = 1.0 / 63.0;
  Picture ramp = flat(500, 500, 0.0F);
  for (std::size_t i = 0; i < ramp.pixel_count(); ++i) {
    ramp.planes[0][i] = static_cast<float>(0.1 + 0.8 * (static_cast<double>(i) + 0.5) / count);
  }
  const Picture out = transform(ramp, PointMap().quantise(bits));
  Plane error(ramp.pixel_count());
  for (std::size_t i = 0; i < error.size(); ++i) error[i] = out.planes[0][i] - ramp.planes[0][i];
  EXPECT_NEAR(moments(error).mean, 0.0,
              0.01 * q);  // the ramp ends inside a level: q / 8 of 50 levels
  EXPECT_NEAR(moments(error).variance, q * q / 12.0, 0.02 * q * q / 12.0);
}

TEST(Quantise, OneBitIsBlackOrWhiteAndLevelsStayPut) {
  const Picture in{4, 1, {{-1.0F, 0.4F, 0.6F, 3.0F}}};
  EXPECT_EQ(transform(in, PointMap().quantise(1)).planes[0], (Plane{0.0F, 0.0F, 1.0F, 1.0F}));
  const Picture level{1, 1, {{static_cast<float>(100.0 / 255.0)}}};
  EXPECT_EQ(transform(level, PointMap().quantise(8)).planes[0], level.planes[0]);
}

TEST(Levels, SharesCountWhiteAndNoiseOfBlack) {
  const Picture in{4, 1, {{0.0F, 0.05F, 0.5F, 1.3F}}};
  EXPECT_EQ(measure_levels(in, 0.0).crushed_share, 0.25);
  EXPECT_EQ(measure_levels(in, 0.06).crushed_share, 0.5);
  EXPECT_EQ(measure_levels(in, 0.0).saturated_share, 0.25);
}

TEST(Conversion, SignalOneIsWhiteAndNothingIsInfinite) {
  const Picture in{3, 1, {{0.02F, 0.01F, std::numeric_limits<float>::max()}}};
  const Plane signal = to_signal(in, 0.02).planes[0];
  EXPECT_FLOAT_EQ(signal[0], 1.0F);
  EXPECT_FLOAT_EQ(signal[1], 0.5F);
  EXPECT_TRUE(std::isfinite(signal[2]));
}

}  // namespace
}  // namespace earthshine::degrade
