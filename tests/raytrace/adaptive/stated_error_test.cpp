// SPDX-License-Identifier: Apache-2.0
// What a picture's statement is worth that pixels' halves tell.
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

// Of n pixels alike the mean of d^2 scatters by the root of 2/3 n d^4 over n; once in ten times
// normal noise is off by more than 1.2816 of that. A pixel that is off by nothing changes nothing.
TEST(Doubt, IsThatOfThePixelsThatHoldTheError) {
  for (const std::size_t n : {1U, 100U}) {
    StatedError stated = grey(200);
    for (std::size_t p = 0; p < n; ++p) stated.squared[p] = {0.01F, 0.0F, 0.0F, 0.02F};
    EXPECT_NEAR(add_up(stated).confidence_factor,
                std::sqrt(1.0 + 1.2816 * std::sqrt(2.0 / 3.0 / static_cast<double>(n))), 1e-6);
  }
  EXPECT_EQ(add_up(grey(200)).confidence_factor, 1.0);
}

// Halves of normal noise of variance 1 in 2500 pixels: once in ten times the true error, 1, is more
// than what is stated and its confidence_factor. 4000 pictures tell that to the root of 0.1 * 0.9 /
// 4000; the sum of 2500 squares has a skewness g of the root of 8 / 2500, and over a spread that is
// told by the same squares that adds phi(z) (2 z^2 + 1) / 6 g, phi the normal density.
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
