// SPDX-License-Identifier: Apache-2.0
// Second moments of the noise, against closed forms and the direct double sum.
#include "degrade/moments/noise_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/units.h"
#include "tests/degrade/covariances.h"

namespace earthshine::degrade {
namespace {

using test::at;
using test::composed;
using test::entry;
using test::lopsided;
using test::matrix;
using test::ramp;

float largest(const Plane& plane) { return *std::max_element(plane.begin(), plane.end()); }

// C'(z, z') = sum over all pixels p of w(z, p) w(z', p) var(p), for white noise var(p): the direct
// sum over all pairs of a small picture, in which every border is near.
void expect_direct_sum(const Covariance& c, const Plane& variance, const AxisMap& along,
                       const AxisMap& across) {
  const std::vector<double> h = matrix(along), v = matrix(across);
  const int columns = along.in, rows = across.in;
  const double scale = static_cast<double>(largest(c.variance()));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      for (int t = 0; t < rows; ++t) {
        for (int s = 0; s < columns; ++s) {
          double sum = 0.0;
          for (int q = 0; q < rows; ++q) {
            for (int p = 0; p < columns; ++p) {
              sum += h[at(p, x, columns)] * h[at(p, s, columns)] * v[at(q, y, rows)] *
                     v[at(q, t, rows)] * static_cast<double>(variance[at(p, q, columns)]);
            }
          }
          ASSERT_NEAR(entry(c, x, y, s, t), sum, 1.3e-6 * scale)
              << x << ", " << y << " with " << s << ", " << t;
        }
      }
    }
  }
}

TEST(NoiseMoments, RampOfVariancesThroughBlursIsTheDirectDoubleSumUpToTheBorders) {
  const Plane variance = ramp(12, 9);
  const AxisMap along = gaussian_blur(12, 0.8), across = gaussian_blur(9, 1.3);
  expect_direct_sum(filtered(white(12, 9, variance), along, across), variance, along, across);
}

TEST(NoiseMoments, LopsidedFiltersAndOneAxisAloneAreTheDirectDoubleSumToo) {
  const Plane variance = ramp(10, 7);
  const AxisMap none_along = gaussian_blur(10, 0.0), none_across = gaussian_blur(7, 0.0);
  const AxisMap along = lopsided(10), across = lopsided(7);
  expect_direct_sum(filtered(white(10, 7, variance), along, across), variance, along, across);
  expect_direct_sum(filtered(white(10, 7, variance), along, none_across), variance, along,
                    none_across);
  expect_direct_sum(filtered(white(10, 7, variance), none_along, across), variance, none_along,
                    across);
}

TEST(NoiseMoments, WiderThanThePictureIsTheDirectDoubleSumToo) {
  const Plane variance = ramp(3, 2);
  const AxisMap along = gaussian_blur(3, 4.0), across = gaussian_blur(2, 3.0);
  expect_direct_sum(filtered(white(3, 2, variance), along, across), variance, along, across);
}

TEST(NoiseMoments, TwoFiltersInSequenceAreTheFilterOfTheirComposition) {
  const Plane variance = ramp(14, 11);
  const AxisMap a = gaussian_blur(14, 0.5), b = lopsided(14);
  const AxisMap c = lopsided(11), d = gaussian_blur(11, 0.9);
  const Covariance twice = filtered(filtered(white(14, 11, variance), a, c), b, d);
  const Covariance once = filtered(white(14, 11, variance), composed(a, b), composed(c, d));
  for (const Covariance* each : {&twice, &once}) {
    expect_direct_sum(*each, variance, composed(a, b), composed(c, d));
  }
}

// sum over n of h(n) h(n + k), h = e^-t I_n(t): the autocorrelation of a discrete Gaussian is the
// discrete Gaussian of twice the variance, e^-2t I_k(2t). For large sigma it approaches the
// continuous exp(-k^2 / 4 s^2) / (2 s sqrt pi), with a difference of order 1 / (16 s^2).
TEST(NoiseMoments, GaussianGrainIsTheClosedForm) {
  for (const double sigma : {0.35, 0.7, 1.5, 4.0}) {
    const Covariance c = filtered(white(101, 5, Plane(505, 0.25F)), gaussian_blur(101, sigma),
                                  gaussian_blur(5, 0.0));
    for (int k = 0; k < 8; ++k) {
      const double bessel = std::exp(-2.0 * sigma * sigma) *
                            std::cyl_bessel_i(static_cast<double>(k), 2.0 * sigma * sigma);
      EXPECT_NEAR(entry(c, 50, 2, 50 + k, 2), 0.25 * bessel, 1e-6 * 0.25) << sigma << ", " << k;
      if (sigma == 4.0) {
        const double smooth = std::exp(-k * k / 64.0) / (8.0 * std::sqrt(base::pi));
        EXPECT_NEAR(bessel, smooth, smooth * 0.01);
      }
    }
    EXPECT_EQ(entry(c, 50, 2, 50, 3), 0.0);
  }
}

TEST(NoiseMoments, OnlyOffsetsThatMatterAreKept) {
  const Covariance c =
      filtered(white(60, 50, Plane(3000, 1.0F)), gaussian_blur(60, 0.35), gaussian_blur(50, 0.35));
  EXPECT_EQ(c.offsets.front(), Offset{});
  for (std::size_t k = 1; k < c.planes.size(); ++k) {
    float most = 0.0F;
    for (const float value : c.planes[k]) most = std::max(most, std::abs(value));
    EXPECT_GT(most, 1e-6F * largest(c.variance()));
    EXPECT_TRUE(c.offsets[k].dy > 0 || (c.offsets[k].dy == 0 && c.offsets[k].dx > 0));
  }
  // rho(k) = I_k(2t) / I_0(2t), 2t = 0.245: 0.122, 0.0074, 3e-4, 9e-6, 2e-7. The largest variance,
  // in the corners, is (1 + rho(1))^2 = 1.26 times the variance in the middle, so that products
  // above 1.26e-6 are kept: (0..4, 0), (0..3, 1), (0..3, 2), (0..2, 3), (0, 4), and their mirror
  // images.
  EXPECT_EQ(c.planes.size(), 25U);
}

TEST(NoiseMoments, GainsScaleEachPairByBothEnds) {
  const int columns = 9, rows = 6;
  const Covariance c = filtered(white(columns, rows, ramp(columns, rows)),
                                gaussian_blur(columns, 0.7), lopsided(rows));
  Plane gain;
  for (std::size_t i = 0; i < 54; ++i) gain.push_back(0.1F * static_cast<float>((i * 7) % 11));
  const Covariance after = scaled(c, gain);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < columns; ++u) {
          const double both = static_cast<double>(gain[at(x, y, columns)]) *
                              static_cast<double>(gain[at(u, v, columns)]);
          ASSERT_NEAR(entry(after, x, y, u, v), both * entry(c, x, y, u, v), 1e-7);
        }
      }
    }
  }
}

// Noise about black, half of it clamped. For zero means, equal sigmas and the correlation rho
//   E max(X, 0) max(Y, 0) = sigma^2 (sqrt(1 - rho^2) + rho (pi - arccos rho)) / 2 pi,
// and each mean is sigma / sqrt(2 pi). The series of the covariance is rho / 4 + rho^2 / 4 pi +
// rho^4 / 48 pi + ..., with positive, decreasing terms. The error of the first two is therefore
// between rho^4 / 48 pi and 3 rho^4 / 48 pi. found: in units of sigma^2.
void expect_two_terms(double found, double rho) {
  const double exact =
      (std::sqrt(1.0 - rho * rho) + rho * (base::pi - std::acos(rho)) - 1.0) / (2.0 * base::pi);
  const double third = std::pow(rho, 4) / (48.0 * base::pi);
  EXPECT_GT(exact - found, third - 1e-6) << rho;
  EXPECT_LT(exact - found, 3.0 * third + 1e-6) << rho;
}

TEST(NoiseMoments, ClampedNeighboursShareTheFirstTwoTermsOfTheClosedForm) {
  const Covariance c =
      filtered(white(30, 30, Plane(900, 0.04F)), gaussian_blur(30, 0.8), gaussian_blur(30, 0.6));
  PointMap clamp;
  clamp.limit_below(0.0);
  const Covariance after = mapped(c, through(clamp, Plane(900, 0.0F), c.variance()));
  const double variance = entry(c, 15, 15, 15, 15);
  EXPECT_NEAR(entry(after, 15, 15, 15, 15), variance * (0.5 - 0.5 / base::pi), 1e-6 * variance);
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}}) {
    expect_two_terms(entry(after, 15, 15, 15 + dx, 15 + dy) / variance,
                     entry(c, 15, 15, 15 + dx, 15 + dy) / variance);
  }
}

// Two frames that share 0.3 of their variance.
TEST(NoiseMoments, ClampedFramesShareTheFirstTwoTermsOfTheirPattern) {
  const Covariance pattern = white(4, 3, Plane(12, 0.3F));
  PointMap clamp;
  clamp.limit_below(0.0);
  const Covariance after = shared(pattern, through(clamp, Plane(12, 0.0F), Plane(12, 1.0F)));
  expect_two_terms(entry(after, 2, 1, 2, 1), 0.3);
}

// Interleaved rows of two fields: n(y) is from field y mod 2, with the covariance C within a field
// and lambda C between them.
TEST(NoiseMoments, WovenFieldsShareWhatLagCarriesAcross) {
  const Covariance c =
      filtered(white(20, 20, Plane(400, 1.0F)), gaussian_blur(20, 0.6), gaussian_blur(20, 0.9));
  const Covariance apart = weave(c, 0.0), lagging = weave(c, 0.4);
  for (const int dy : {0, 1, 2, 3}) {
    for (const int dx : {-1, 0, 1}) {
      const double before = entry(c, 10, 10, 10 + dx, 10 + dy);
      EXPECT_FLOAT_EQ(static_cast<float>(entry(apart, 10, 10, 10 + dx, 10 + dy)),
                      static_cast<float>(dy % 2 == 0 ? before : 0.0));
      EXPECT_FLOAT_EQ(static_cast<float>(entry(lagging, 10, 10, 10 + dx, 10 + dy)),
                      static_cast<float>(dy % 2 == 0 ? before : 0.4 * before));
    }
  }
}

TEST(NoiseMoments, IndependentNoisesAdd) {
  const Covariance grain =
      filtered(white(8, 8, Plane(64, 1.0F)), gaussian_blur(8, 0.0), gaussian_blur(8, 0.5));
  const Covariance other =
      filtered(white(8, 8, Plane(64, 2.0F)), gaussian_blur(8, 0.5), gaussian_blur(8, 0.0));
  const Covariance sum = plus(grain, times(other, 3.0));
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      const double expected = entry(grain, 2, 2, x, y) + 3.0 * entry(other, 2, 2, x, y);
      EXPECT_NEAR(entry(sum, 2, 2, x, y), expected, 1e-6);
    }
  }
  EXPECT_THROW((void)plus(grain, white(8, 7, Plane(56, 1.0F))), base::Error);
}

TEST(NoiseMoments, FiltersThatDoNotFitAreRefused) {
  const Covariance c = white(6, 5, Plane(30, 1.0F));
  const AxisMap six = gaussian_blur(6, 1.0), five = gaussian_blur(5, 1.0);
  EXPECT_THROW((void)filtered(c, five, five), base::Error);
  EXPECT_THROW((void)filtered(c, area_average(6, 3), five), base::Error);
  EXPECT_THROW((void)variance_after(c, six, six), base::Error);
  EXPECT_THROW((void)covariance_between(c, {six, five}, {six, six}), base::Error);
}

TEST(NoiseMoments, WideFiltersThatDoNotFitAreRefusedBeforeTheWork) {
  // With a filter as wide as the picture every pair of 200 columns is correlated: at least 200
  // offsets of 200 x 200 floats each, 32 MB.
  const int size = 200;
  const AxisMap wide = gaussian_blur(size, 60.0);
  const Covariance noise = white(size, size, Plane(std::size_t{size} * size, 1.0F));
  const base::MemoryLimit limit(std::uint64_t{1} << 20U);
  try {
    (void)filtered(noise, gaussian_blur(size, 0.0), wide);
    FAIL() << "it was worked out";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.blame(), base::Blame::Work);
    EXPECT_NE(std::string(error.what()).find("offsets"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace earthshine::degrade
