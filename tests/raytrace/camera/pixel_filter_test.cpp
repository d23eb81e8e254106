// SPDX-License-Identifier: Apache-2.0
#include "raytrace/camera/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace earthshine::raytrace {
namespace {

using scenes::FilterShape;

struct Row {
  FilterShape shape;
  double width_px;
  double variance;  // closed form, of width 1
};

// Triangle of full width w: w^2/24. Gaussian of s = w/6 cut at 3 s:
// s^2 (1 - 2 z p(z) / (2 P(z) - 1)), z = 3, p and P the normal density and distribution.
// Blackman-Harris: the integral of x^2 cos (2 pi k x/w) over the support is w^3 (-1)^k / (2 pi^2
// k^2), for k = 0 w^3/12, and only a0 contributes to the integral of the filter.
double gaussian_variance() {
  const double z = 3.0, density = std::exp(-z * z / 2) / std::sqrt(2.0 * base::pi);
  return (1.0 - 2.0 * z * density / std::erf(z / std::sqrt(2.0))) / 36.0;
}
double blackman_harris_variance() {
  const double a[] = {0.35875, 0.48829, 0.14128, 0.01168};
  double sum = 1.0 / 12.0;
  for (int k = 1; k < 4; ++k) {
    sum += (k % 2 == 0 ? 1.0 : -1.0) * a[k] / a[0] / (2.0 * base::pi * base::pi * k * k);
  }
  return sum;
}

class Filters : public ::testing::TestWithParam<Row> {};

TEST_P(Filters, MomentsOfTheOffsetsAreTheFilters) {
  // Midpoints of 2^16 equal shares: the mean is 0 by symmetry, the variance the integral's.
  const PixelFilter filter(GetParam().shape, GetParam().width_px);
  constexpr int n = 1 << 16;
  double mean = 0.0, square = 0.0;
  for (int k = 0; k < n; ++k) {
    const double x = filter.offset((k + 0.5) / n, 0.5)[0];
    mean += x / n;
    square += x * x / n;
  }
  const double variance = GetParam().variance * GetParam().width_px * GetParam().width_px;
  EXPECT_NEAR(mean, 0.0, 1e-12);
  EXPECT_NEAR(square / variance, 1.0, 1e-5);
}

TEST_P(Filters, OffsetsGrowWithTheirNumberWithinTheSupportAndAreOddAboutTheCentre) {
  const PixelFilter filter(GetParam().shape, GetParam().width_px);
  double last = -0.5 * GetParam().width_px;
  EXPECT_DOUBLE_EQ(filter.offset(0.0, 1.0)[0], last);
  EXPECT_DOUBLE_EQ(filter.offset(0.0, 1.0)[1], -last);
  for (int k = 1; k <= 1000; ++k) {
    const auto at = filter.offset(k / 1000.0, 1.0 - k / 1000.0);
    EXPECT_GT(at[0], last);
    EXPECT_NEAR(at[0], -at[1], 1e-12);
    last = at[0];
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Filters,
                         ::testing::Values(Row{FilterShape::Box, 1.0, 1.0 / 12.0},
                                           Row{FilterShape::Box, 2.5, 1.0 / 12.0},
                                           Row{FilterShape::Triangle, 2.0, 1.0 / 24.0},
                                           Row{FilterShape::Gaussian, 3.0, gaussian_variance()},
                                           Row{FilterShape::BlackmanHarris, 4.0,
                                               blackman_harris_variance()}));

TEST(PixelFilter, BlackmanHarrisSharesAreItsIntegral) {
  // u maps to the x with the integral u below it; at a quarter of the width, where t = pi/2: (a0
  // pi/2 + a1 - a3/3 + a0 pi) / (2 pi a0).
  const double a0 = 0.35875, a1 = 0.48829, a3 = 0.01168;
  const double share = (1.5 * base::pi * a0 + a1 - a3 / 3.0) / (2.0 * base::pi * a0);
  EXPECT_NEAR(PixelFilter(FilterShape::BlackmanHarris, 4.0).offset(share, 0.5)[0], 1.0, 1e-6);
}

// A share du of the offsets is within d(offset), one axis at a time: density = du / d(offset).
TEST(PixelFilter, DensityIsThatOfTheOffsets) {
  for (const FilterShape shape : {FilterShape::Box, FilterShape::Triangle, FilterShape::Gaussian,
                                  FilterShape::BlackmanHarris}) {
    const PixelFilter filter(shape, 3.0);
    const auto at = [&](double u) { return filter.offset(u, 0.5)[0]; };
    for (const double u : {0.05, 0.2, 0.47, 0.8, 0.99}) {
      const double h = 1e-4, slope = 2.0 * h / (at(u + h) - at(u - h));
      const double along_y = 2.0 * h / (at(0.5 + h) - at(0.5 - h));
      EXPECT_NEAR(filter.density({at(u), 0.0}) / (slope * along_y), 1.0, 1e-3);
    }
    EXPECT_EQ(filter.density({1.6, 0.0}), 0.0);
  }
}

TEST(PixelFilter, BoxOfOnePixelIsThePixelExactly) {
  const PixelFilter filter((scenes::Camera()));
  for (const float u : {0.0F, 0.1F, 0.7654321F, 0.99999994F}) {
    // Bit for bit: older pictures stay the same.
    EXPECT_EQ(17 + 0.5 + filter.offset(double(u), 0.0)[0], 17 + double(u));
  }
}

}  // namespace
}  // namespace earthshine::raytrace
