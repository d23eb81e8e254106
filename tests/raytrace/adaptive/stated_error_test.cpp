// SPDX-License-Identifier: Apache-2.0
// The confidence factor of an error that the halves of pixels state.
#include "raytrace/adaptive/stated_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace earthshine::raytrace {
namespace {

// Pixels of luminance 1, all of which count.
StatedError grey(std::size_t pixels) {
  StatedError stated(pixels);
  std::ranges::fill(stated.luminance, 1.0F);
  std::ranges::fill(stated.shows, Shows::Surface);
  return stated;
}

// For n equal pixels the mean of d^2 has the standard error sqrt(2/3 n d^4) / n; normal noise
// exceeds 1.2816 standard errors once in ten times. Pixels without an error change nothing.
TEST(Doubt, IsThatOfThePixelsThatHoldTheError) {
  for (const std::size_t n : {1U, 100U}) {
    StatedError stated = grey(200);
    for (std::size_t p = 0; p < n; ++p) stated.squared[p] = {0.01F, 0.0F, 0.0F, 0.02F};
    EXPECT_NEAR(add_up(stated).confidence_factor,
                std::sqrt(1.0 + 1.2816 * std::sqrt(2.0 / 3.0 / static_cast<double>(n))), 1e-6);
  }
  EXPECT_EQ(add_up(grey(200)).confidence_factor, 1.0);
}

// Half differences of normal noise of variance 1 in 2500 pixels: once in ten times the true error,
// 1, exceeds the stated error times its confidence_factor. 4000 pictures measure this to
// sqrt(0.1 * 0.9 / 4000). The sum of 2500 squares has a skewness g = sqrt(8 / 2500). With a
// standard error from the same squares, this adds phi(z) (2 z^2 + 1) / 6 g, phi the normal density.
TEST(Doubt, IsExceededOnceInTenTimes) {
  constexpr int pictures = 4000;
  constexpr std::size_t pixels = 2500;
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal;
  StatedError stated = grey(pixels);
  int exceeded = 0;
  for (int picture = 0; picture < pictures; ++picture) {
    for (std::size_t p = 0; p < pixels; ++p) {
      const float d = normal(random);
      stated.squared[p][3] = d * d;
    }
    const ErrorSums sums = add_up(stated);
    if (sums.confidence_factor * std::sqrt(sums.squared_error()) < 1.0) ++exceeded;
  }
  const double density = 0.17550, z = 1.2816;
  const double skewed = density * (2.0 * z * z + 1.0) / 6.0 * std::sqrt(8.0 / pixels);
  EXPECT_NEAR(double(exceeded) / pictures, 0.1 + skewed, 4.0 * std::sqrt(0.09 / pictures));
}

}  // namespace
}  // namespace earthshine::raytrace
