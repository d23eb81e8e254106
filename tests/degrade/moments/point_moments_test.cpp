// SPDX-License-Identifier: Apache-2.0
#include "degrade/moments/point_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/numbers/random.h"
#include "base/parallel.h"
#include "degrade/parts/noise.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

PointMap clamp_and_gamma(double white, double gamma) {
  PointMap map;
  map.limit_below(0.0).limit_above(white).power(1.0 / gamma);
  return map;
}

// v = min(max(S, 0), W)^(1/gamma) by the midpoint rule, plus the clipped shares at both ends.
// Integrates over S, or, if v is steep at 0, over v, where S = v^gamma and
// dS = gamma v^(gamma - 1) dv. The slope is the integral of the density of S over dv.
PointMoments by_fine_sum(double mu, double sigma, double white, double gamma) {
  const double exponent = std::max(1.0, gamma);  // S = u^exponent, v = u^(exponent / gamma)
  const double low = std::pow(std::clamp(mu - 9.0 * sigma, 0.0, white), 1.0 / exponent);
  const double high = std::pow(std::clamp(mu + 9.0 * sigma, 0.0, white), 1.0 / exponent);
  constexpr int steps = 40'000;
  const double du = (high - low) / steps;
  std::vector<double> value, share;
  const auto add = [&](double v, double p) {
    value.push_back(v);
    share.push_back(p);
  };
  add(0.0, normal_probability(-mu / sigma));
  add(std::pow(white, 1.0 / gamma), normal_probability((mu - white) / sigma));
  PointMoments m;
  for (int k = 0; k < steps; ++k) {
    const double u = low + (k + 0.5) * du, s = std::pow(u, exponent), v = std::pow(s, 1.0 / gamma);
    const double p = normal_density((s - mu) / sigma) / sigma * du;
    add(v, p * exponent * s / u);
    const double rise = p * exponent / gamma * v / u;  // f'(S) p(S) dS
    m.slope += rise;
    m.curvature += rise * (s - mu) / (sigma * sigma);
  }
  for (std::size_t k = 0; k < value.size(); ++k) m.mean += share[k] * value[k];
  for (std::size_t k = 0; k < value.size(); ++k) {
    m.variance += share[k] * (value[k] - m.mean) * (value[k] - m.mean);
  }
  return m;
}

void expect_near(const PointMoments& found, const PointMoments& expected, double sigma,
                 double tolerance) {
  const double deviation = std::sqrt(expected.variance);
  EXPECT_NEAR(found.mean, expected.mean, tolerance * deviation + 1e-10 * sigma);
  EXPECT_NEAR(std::sqrt(found.variance), deviation, tolerance * deviation + 1e-10 * sigma);
  // |slope| sigma is at most the standard deviation.
  EXPECT_NEAR(found.slope * sigma, expected.slope * sigma, tolerance * deviation + 1e-10 * sigma);
  EXPECT_NEAR(found.curvature * sigma * sigma, expected.curvature * sigma * sigma,
              2.0 * tolerance * deviation + 1e-10 * sigma);
}

// V29: z = (W - mu) / sigma; E = mu P + W (1 - P) - sigma p;
// E2 = (mu^2 + sigma^2) P - sigma (mu + W) p + W^2 (1 - P); the saturated share is 1 - P.
TEST(PointMoments, ClipAtWhiteIsTheClosedForm) {
  const double white = 1.1;
  for (const double mu : {0.2, 0.9, 1.1, 1.4}) {
    for (const double sigma : {0.02, 0.3, 2.0}) {
      const double z = (white - mu) / sigma, P = normal_probability(z), p = normal_density(z);
      const double mean = mu * P + white * (1.0 - P) - sigma * p;
      const double square =
          (mu * mu + sigma * sigma) * P - sigma * (mu + white) * p + white * white * (1.0 - P);
      const PointMoments m = clamped(mu, sigma, -infinite, white);
      EXPECT_NEAR(m.mean, mean, 1e-12);
      EXPECT_NEAR(m.variance, square - mean * mean, 1e-12);
      EXPECT_NEAR(m.slope, P, 1e-15);
      EXPECT_NEAR(m.curvature, -p / sigma, 1e-12);
    }
  }
}

// Half of a Gaussian about 0 is clamped: mean sigma / sqrt(2 pi), second moment sigma^2 / 2.
TEST(PointMoments, ClampAtBlackOfPureNoiseIsTheHalfGaussian) {
  const PointMoments m = clamped(0.0, 0.4, 0.0, infinite);
  EXPECT_NEAR(m.mean, 0.4 / std::sqrt(2.0 * base::pi), 1e-15);
  EXPECT_NEAR(m.variance, 0.16 * (0.5 - 0.5 / base::pi), 1e-15);
  EXPECT_NEAR(m.slope, 0.5, 1e-15);
}

TEST(PointMoments, QuadratureOfTheTwoSidedClampIsItsClosedForm) {
  PointMap map;
  map.limit_below(0.0).limit_above(1.1);
  for (const double mu : {-2.0, -0.3, 0.0, 0.01, 0.5, 1.05, 1.1, 3.0}) {
    for (const double sigma : {1e-5, 1e-3, 0.03, 0.3, 1.0, 30.0}) {
      SCOPED_TRACE(std::to_string(mu) + " +- " + std::to_string(sigma));
      expect_near(through(map, mu, sigma), clamped(mu, sigma, 0.0, 1.1), sigma, 1e-6);
    }
  }
}

TEST(PointMoments, GammaIsTheFineIntegral) {
  for (const double gamma : {0.45, 2.2, 5.0}) {
    const PointMap map = clamp_and_gamma(1.1, gamma);
    for (const double sigma : {1e-4, 0.01, 0.1, 1.0, 20.0}) {
      for (const double sigmas : {-3.0, -1.0, 0.0, 0.5, 2.0, 6.0, 7.5, 30.0}) {
        const double mu = std::min(sigmas * sigma, 1.5);
        SCOPED_TRACE(std::to_string(gamma) + ": " + std::to_string(mu) + " +- " +
                     std::to_string(sigma));
        expect_near(through(map, mu, sigma), by_fine_sum(mu, sigma, 1.1, gamma), sigma, 2e-6);
      }
    }
  }
}

TEST(PointMoments, WithoutNoiseAMapGivesItsValue) {
  PointMap map = clamp_and_gamma(1.1, 2.2);
  map.quantise(6).screen(1.0, 100.0, 2.2);
  for (const double s : {-0.1, 0.0, 0.013, 0.5, 1.0, 2.0}) {
    const PointMoments m = through(map, s, 0.0);
    EXPECT_EQ(m.mean, map(s));
    EXPECT_EQ(m.variance, 0.0);
    EXPECT_EQ(m.slope, 0.0);
    EXPECT_EQ(m.curvature, 0.0);
  }
}

// One bit, 1 above one half: mean P, variance P (1 - P), slope p / sigma, curvature dp / dmu.
TEST(PointMoments, OneBitIsACoin) {
  PointMap map;
  map.quantise(1);
  for (const double mu : {0.1, 0.5, 0.58}) {
    const double z = (mu - 0.5) / 0.1, P = normal_probability(z);
    const PointMoments m = through(map, mu, 0.1);
    EXPECT_NEAR(m.mean, P, 1e-12);
    EXPECT_NEAR(m.variance, P * (1.0 - P), 1e-12);
    EXPECT_NEAR(m.slope, normal_density(z) / 0.1, 1e-12);
    EXPECT_NEAR(m.curvature, -z * normal_density(z) / 0.01, 1e-10);
  }
}

// V25: noise of more than a step is a dither. Rounding then adds 1/12 of a squared step and no
// bias, and the slope is 1 (the error is of order exp(-2 pi^2 (sigma / step)^2)).
TEST(PointMoments, RoundingOfNoiseAddsATwelfthOfASquaredStep) {
  const double step = 1.0 / 255.0;
  PointMap map;
  map.quantise(8);
  for (const double sigmas : {1.0, 5.0}) {
    const double sigma = sigmas * step;
    const PointMoments m = through(map, 0.4037, sigma);
    EXPECT_NEAR(m.mean, 0.4037, 1e-7 * step);
    EXPECT_NEAR(m.variance, sigma * sigma + step * step / 12.0, 2e-7 * step * step);
    EXPECT_NEAR(m.slope, 1.0, 1e-6);
  }
}

TEST(PointMap, IsTheStagesItIsMadeOf) {
  PointMap map;
  map.limit_below(0.0).amplify(3.0).limit_above(1.1).power(1.0 / 2.2).quantise(5).screen(2.0, 90.0,
                                                                                         2.5);
  for (double s = -0.1; s < 0.45; s += 0.00137) {
    const double amplified = std::min(3.0 * std::max(s, 0.0), 1.1);
    const double level = std::min(std::round(std::pow(amplified, 1.0 / 2.2) * 31.0), 31.0) / 31.0;
    EXPECT_NEAR(map(s), 2.0 + 88.0 * std::pow(level, 2.5), 1e-9);
  }
}

// Two bits have the levels 0, 1/3, 2/3, 1 and kinks at v = 1/6, 1/2, 5/6, where S = v^2 / gain.
TEST(PointMap, KinksAreTracedBackToTheSignal) {
  PointMap map;
  map.limit_below(0.0).amplify(4.0).limit_above(0.81).power(0.5);
  ASSERT_EQ(map.kinks().size(), 2U);
  EXPECT_EQ(map.kinks()[0], 0.0);
  EXPECT_NEAR(map.kinks()[1], 0.81 / 4.0, 1e-15);
  map.quantise(2);
  ASSERT_EQ(map.kinks().size(), 5U);
  EXPECT_NEAR(map.kinks()[1], 1.0 / 144.0, 1e-15);
  EXPECT_NEAR(map.kinks()[2], 1.0 / 16.0, 1e-15);
  EXPECT_NEAR(map.kinks()[3], 25.0 / 144.0, 1e-15);
  for (const PointMap::Stretch& stretch : map.stretches()) EXPECT_TRUE(stretch.level);
  EXPECT_NEAR(map.stretches()[4].value, 1.0, 1e-15);
}

// Between 0.2 and 0.4 two bits have the single level 1/3; no threshold is inside.
TEST(PointMap, KinksOutOfReachAreNone) {
  PointMap map;
  map.limit_below(0.2).limit_above(0.4).quantise(2);
  EXPECT_EQ(map.kinks(), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(through(map, 0.3, 0.2).variance, 0.0);
}

struct Pixels {
  Plane mean, variance;
};
// 40 000 pixels, so that a table is used; sigma is uniform in its logarithm.
Pixels many(double least, double most, double least_sigma, double most_sigma) {
  Pixels pixels;
  base::Rng rng(base::Key(5, base::Stream::Test, 0));
  for (int i = 0; i < 40'000; ++i) {
    pixels.mean.push_back(static_cast<float>(least + (most - least) * rng.next()));
    const double sigma = least_sigma * std::pow(most_sigma / least_sigma, rng.next());
    pixels.variance.push_back(static_cast<float>(sigma * sigma));
  }
  return pixels;
}

// Where f is nearly constant, the tolerance is relative to the rise of f within six sigma.
void expect_each_on_its_own(const PointMap& map, const Pixels& pixels) {
  const MomentPlanes planes = through(map, pixels.mean, pixels.variance);
  for (std::size_t i = 0; i < pixels.mean.size(); i += 7) {
    const double mu = static_cast<double>(pixels.mean[i]);
    const double sigma = std::sqrt(static_cast<double>(pixels.variance[i]));
    const PointMoments one = through(map, mu, sigma);
    const double rise = map(mu + 6.0 * sigma) - map(mu - 6.0 * sigma);
    const double tolerance = 1e-4 * std::sqrt(one.variance) + 1e-5 * rise;
    SCOPED_TRACE(std::to_string(mu) + " +- " + std::to_string(sigma));
    ASSERT_NEAR(planes.mean[i], one.mean, tolerance + 1e-7 * one.mean);
    ASSERT_NEAR(planes.slope[i] * sigma, one.slope * sigma, tolerance);
    ASSERT_NEAR(planes.curvature[i] * sigma * sigma, one.curvature * sigma * sigma, tolerance);
    ASSERT_NEAR(planes.variance[i], one.variance, 1e-4 * one.variance + 1e-6 * rise * rise);
  }
}

TEST(PointMoments, ManyPixelsAgreeWithEachOnItsOwn) {
  const PointMap smooth = clamp_and_gamma(1.1, 2.2);
  PointMap stepped = smooth;
  stepped.quantise(6).screen(1.0, 100.0, 2.2);
  for (const PointMap& map : {smooth, stepped}) {
    expect_each_on_its_own(map, many(-0.1, 1.2, 0.02, 0.2));      // all of a noisy picture
    expect_each_on_its_own(map, many(-0.001, 0.004, 1e-3, 0.1));  // black
    expect_each_on_its_own(map, many(0.39, 0.43, 2e-3, 8e-3));    // within a step of 0.02
    expect_each_on_its_own(map, many(0.0, 1.0, 1e-5, 1e-4));      // very little noise
  }
}

TEST(PointMoments, SameBitsOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const base::ThreadLimit limit(threads);
    const Pixels pixels = many(-0.1, 1.2, 1e-4, 0.2);
    const MomentPlanes planes = through(clamp_and_gamma(1.1, 2.2), pixels.mean, pixels.variance);
    return std::vector<Plane>{planes.mean, planes.variance, planes.slope, planes.curvature};
  };
  EXPECT_EQ(run(1), run(16));
}

// Amplifier noise at a signal below its sigma, clamped at black, after gamma: mean of the samples
// with the standard error s / sqrt(M), and their variance with the standard error
// s^2 sqrt((kurtosis - 1) / M).
TEST(PointMoments, DrawnNoiseHasThePredictedMomentsBehindClampAndGamma) {
  const NoiseLaw law{0.0025, 0.0, 0.0, false};
  PointMap map;
  map.limit_below(0.0).power(1.0 / 2.2);
  const Picture noisy = add_read_noise(test::flat(300, 300, 0.03F), law, {});
  const test::Moments drawn = test::moments(transform(noisy, map).planes.front());
  const PointMoments m = through(map, 0.03, 0.05);
  EXPECT_NEAR(drawn.mean, m.mean, 4.0 * std::sqrt(m.variance / 90'000.0));
  const double kurtosis = drawn.fourth / (drawn.variance * drawn.variance);
  EXPECT_NEAR(drawn.variance / m.variance, 1.0, 4.0 * std::sqrt((kurtosis - 1.0) / 90'000.0));
}

}  // namespace
}  // namespace earthshine::degrade
