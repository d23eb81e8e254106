// SPDX-License-Identifier: Apache-2.0
#include "degrade/stage/axis_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/units.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;

double kernel_moment(const std::vector<double>& kernel, int power) {
  const int radius = static_cast<int>(kernel.size() / 2);
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k) {
    sum += kernel[static_cast<std::size_t>(k + radius)] * std::pow(k, power);
  }
  return sum;
}

TEST(AreaAverage, ConstantsStayExactlyConstantAtEveryRatio) {
  const Picture in = flat(37, 23, 0.7F);
  for (const int out : {1, 2, 5, 23, 36, 37, 38, 74, 300}) {
    const Picture mapped = apply(in, area_average(37, out), area_average(23, out));
    for (float value : mapped.planes[0]) ASSERT_EQ(value, 0.7F) << out;
  }
}

TEST(AreaAverage, IntegerRatioIsTheBlockMean) {
  Picture in = flat(6, 4, 0.0F);
  std::iota(in.planes[0].begin(), in.planes[0].end(), 1.0F);
  const Picture out = apply(in, area_average(6, 3), area_average(4, 2));
  // Block of 1, 2, 7, 8: mean 4.5. Blocks differ by 2 along and by 12 across.
  EXPECT_EQ(out.planes[0], (Plane{4.5F, 6.5F, 8.5F, 16.5F, 18.5F, 20.5F}));
}

TEST(AreaAverage, TotalLightIsKeptAtAnyRatio) {
  Picture in = flat(41, 1, 0.0F);
  for (std::size_t i = 0; i < 41; ++i) in.planes[0][i] = static_cast<float>((i * 29) % 17);
  const double mean = test::moments(in.planes[0]).mean;
  for (const int out : {3, 40, 41, 97, 300}) {
    const Picture mapped = apply(in, area_average(41, out), area_average(1, 1));
    EXPECT_NEAR(test::moments(mapped.planes[0]).mean, mean, 1e-6 * mean) << out;
  }
}

// Half-pixel centres: the centroid of pixel i of n is at (i + 1/2) / n on both grids. Exact if the
// sizes divide; a pixel shared by two outputs may move by an eighth of an output.
TEST(AreaAverage, ImpulseKeepsItsCentroidUpTheScale) {
  for (const int at : {0, 7, 39}) {
    Picture in = flat(40, 1, 0.0F);
    in.planes[0][static_cast<std::size_t>(at)] = 1.0F;
    const Picture out = apply(in, area_average(40, 320), area_average(1, 1));
    double sum = 0.0, first = 0.0;
    for (std::size_t i = 0; i < 320; ++i) {
      sum += static_cast<double>(out.planes[0][i]);
      first += static_cast<double>(out.planes[0][i]) * (static_cast<double>(i) + 0.5) / 320.0;
    }
    EXPECT_NEAR(first / sum, (at + 0.5) / 40.0, 1e-6 / 40.0) << at;
  }
}

// A mean over w pixels has the response sin(pi w f) / (w sin(pi f)) at frequency f. At 1.5 times
// the Nyquist frequency of the output, f = 0.75 / w with w = 16, this is 0.30120 (continuous:
// sinc 0.75 = 0.3001).
TEST(AreaAverage, FrequenciesAboveNyquistAreAttenuatedAsTheBoxSays) {
  constexpr int size = 3200, width = 16;
  Picture in = flat(size, 1, 0.0F);
  for (std::size_t i = 0; i < size; ++i) {
    const double x = static_cast<double>(i) + 0.5;
    in.planes[0][i] = static_cast<float>(std::cos(2.0 * base::pi * 0.75 / width * x));
  }
  const Picture out = apply(in, area_average(size, size / width), area_average(1, 1));
  const double amplitude = std::sqrt(2.0 * test::moments(out.planes[0]).variance);
  EXPECT_NEAR(amplitude, 0.30120, 2e-5);
}

TEST(DiscreteGaussian, SumsToOneWithVarianceSigmaSquared) {
  for (const double sigma : {0.05, 0.2, 0.35, 0.5, 1.0, 2.5, 10.0}) {
    const std::vector<double> kernel = discrete_gaussian(sigma);
    EXPECT_NEAR(kernel_moment(kernel, 0), 1.0, 1e-8) << sigma;
    EXPECT_NEAR(kernel_moment(kernel, 1), 0.0, 1e-12) << sigma;
    EXPECT_NEAR(kernel_moment(kernel, 2), sigma * sigma, 1e-6 * (1.0 + sigma * sigma)) << sigma;
  }
}

// sum h_n cos(2 pi f n) = exp(-t (1 - cos 2 pi f)): the generating function of the Bessel
// functions.
TEST(DiscreteGaussian, TransferFunctionIsItsClosedForm) {
  for (const double sigma : {0.35, 1.0, 3.0}) {
    const std::vector<double> kernel = discrete_gaussian(sigma);
    const int radius = static_cast<int>(kernel.size() / 2);
    for (const double f : {0.0, 0.1, 0.25, 0.4, 0.5}) {
      double sum = 0.0;
      for (int n = -radius; n <= radius; ++n) {
        sum += kernel[static_cast<std::size_t>(n + radius)] * std::cos(2.0 * base::pi * f * n);
      }
      EXPECT_NEAR(sum, std::exp(-sigma * sigma * (1.0 - std::cos(2.0 * base::pi * f))), 1e-8);
    }
  }
}

Picture pattern(int columns, int rows) {
  Picture picture = flat(columns, rows, 0.0F);
  for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
    picture.planes[0][i] = static_cast<float>((i * 7919) % 101);
  }
  return picture;
}

Picture blurred(const Picture& in, double along, double across) {
  return apply(in, gaussian_blur(in.columns, along), gaussian_blur(in.rows, across));
}

TEST(Blur, FlatFieldStaysFlatUpToTheBorder) {
  const Picture out = blurred(flat(20, 30, 0.3F), 2.0, 5.0);
  for (float value : out.planes[0]) ASSERT_FLOAT_EQ(value, 0.3F);
}

TEST(Blur, ImpulseAnywhereKeepsItsLight) {
  for (const std::size_t at : {0U, 3U, 209U, 399U}) {
    Picture in = flat(20, 20, 0.0F);
    in.planes[0][at] = 1000.0F;
    EXPECT_NEAR(test::moments(blurred(in, 1.5, 0.4).planes[0]).mean * 400.0, 1000.0, 1e-3) << at;
  }
}

TEST(Blur, RampStaysTheSameRampAwayFromTheBorder) {
  Picture in = flat(60, 1, 0.0F);
  for (std::size_t i = 0; i < 60; ++i) in.planes[0][i] = static_cast<float>(i);
  const Picture out = blurred(in, 1.2, 0.0);
  for (std::size_t i = 15; i < 45; ++i) EXPECT_NEAR(out.planes[0][i], in.planes[0][i], 1e-4);
}

TEST(Blur, TwoCascadeAsTheRootOfTheSumOfSquaresAndInEitherOrder) {
  const Picture in = pattern(50, 40);
  const Picture ab = blurred(blurred(in, 0.6, 0.3), 0.8, 0.4);
  const Picture ba = blurred(blurred(in, 0.8, 0.4), 0.6, 0.3);
  const Picture once = blurred(in, 1.0, 0.5);
  for (std::size_t i = 0; i < in.pixel_count(); ++i) {
    EXPECT_NEAR(ab.planes[0][i], ba.planes[0][i], 1e-4);
    EXPECT_NEAR(ab.planes[0][i], once.planes[0][i], 1e-4);
  }
}

TEST(Blur, SeparableEqualsTheTwoDimensionalSum) {
  const Picture in = pattern(31, 31);
  const std::vector<double> along = discrete_gaussian(0.7), across = discrete_gaussian(0.4);
  const int ra = static_cast<int>(along.size() / 2), rc = static_cast<int>(across.size() / 2);
  double direct = 0.0;
  for (int dy = -rc; dy <= rc; ++dy) {
    for (int dx = -ra; dx <= ra; ++dx) {
      direct +=
          across[static_cast<std::size_t>(dy + rc)] * along[static_cast<std::size_t>(dx + ra)] *
          static_cast<double>(in.planes[0][static_cast<std::size_t>((15 + dy) * 31 + 15 + dx)]);
    }
  }
  EXPECT_NEAR(blurred(in, 0.7, 0.4).planes[0][15 * 31 + 15], direct, 1e-4);
}

TEST(Blur, WiderThanThePictureIsStillAMean) {
  const Picture out = blurred(pattern(2, 1), 10.0, 10.0);
  const Plane in = pattern(2, 1).planes[0];
  EXPECT_NEAR(out.planes[0][0], (in[0] + in[1]) / 2.0F, 1e-3);
}

}  // namespace
}  // namespace earthshine::degrade
