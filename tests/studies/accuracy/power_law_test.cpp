// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/power_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/numbers/random.h"

namespace earthshine::studies {
namespace {

std::vector<ErrorAt> points_of(double factor, double exponent, double floor, int count,
                               double step = 4.0, double noise = 0.0, std::uint64_t seed = 1) {
  std::vector<ErrorAt> points;
  base::Rng rng(base::Key(seed, base::Stream::Test, 0));
  double x = 4.0;
  for (int k = 0; k < count; ++k, x *= step) {
    // Twelve uniform numbers have variance 12 / 12 = 1: their sum minus 6 is nearly normal.
    double normal = -6.0;
    for (int j = 0; j < 12; ++j) normal += rng.next();
    points.push_back(
        {x, std::hypot(factor * std::pow(x, -exponent), floor) * std::exp(noise * normal)});
  }
  return points;
}

TEST(PowerLaw, ExactPointsGiveTheirExponentAndNoFloor) {
  for (const double exponent : {0.5, 0.6, 1.0, -0.25}) {
    const auto law = fit_power_law(points_of(0.3, exponent, 0.0, 6));
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->exponent, exponent, 1e-9);
    EXPECT_NEAR(law->factor, 0.3, 1e-9);
    EXPECT_EQ(law->floor, 0.0);
    EXPECT_NEAR(*law->exponent_error, 0.0, 1e-6);
  }
}

// e^2 = (0.5 x^-0.7)^2 + 0.01^2: a straight line through these would have a smaller exponent.
TEST(PowerLaw, FloorIsFoundAndDoesNotSpoilTheExponent) {
  const auto law = fit_power_law(points_of(0.5, 0.7, 0.01, 7));
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.7, 1e-4);
  EXPECT_NEAR(law->floor, 0.01, 1e-5);
  EXPECT_NEAR(law->error_at(4.0), std::hypot(0.5 * std::pow(4.0, -0.7), 0.01), 1e-6);
}

// Least squares on a line with noise s of ln e: the slope's standard error is
// s / sqrt(sum (t - mean t)^2); for t = k ln 4, k = 0..9, the sum is 82.5 ln^2 4. Estimated from
// the residuals it has a chi-square distribution of 8 degrees of freedom: over 400 draws the mean
// of its square is s^2 / 82.5 ln^2 4 with the relative error sqrt(2 / 8 / 400) = 2.5 %.
TEST(PowerLaw, StandardErrorIsThatOfTheSlope) {
  constexpr int draws = 400;
  constexpr double noise = 0.1;
  double squares = 0.0, off = 0.0;
  int lines = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const auto law = fit_power_law(
        points_of(1.0, 0.5, 0.0, 10, 4.0, noise, 1000 + static_cast<std::uint64_t>(draw)));
    if (law->floor > 0.0) continue;
    ++lines;
    squares += std::pow(*law->exponent_error, 2);
    off += std::pow(law->exponent - 0.5, 2);
  }
  // Chance sometimes makes a floor significant: F > 4 of 1 and 7 degrees of freedom has a
  // probability of 8.6 %, in half of these cases with the curvature of a floor.
  EXPECT_GT(lines, 0.85 * draws);
  const double expected = noise * noise / (82.5 * std::pow(std::log(4.0), 2));
  EXPECT_NEAR(squares / lines, expected, 0.15 * expected);
  EXPECT_NEAR(off / lines, expected, 0.30 * expected);  // 4 sqrt(2 / 400), and without the draws
                                                        // with a floor
}

TEST(PowerLaw, TwoPointsHaveALineWithoutStandardError) {
  const auto law = fit_power_law({{10.0, 0.2}, {1000.0, 0.02}});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.5, 1e-12);
  EXPECT_FALSE(law->exponent_error);
}

TEST(PowerLaw, HoldsOnlyWhereThePointsShowIt) {
  EXPECT_TRUE(fit_power_law(points_of(0.3, 0.5, 0.0, 6))->holds());
  EXPECT_TRUE(fit_power_law(points_of(0.5, 0.7, 0.01, 7))->holds());
  // Two points fit any line; a fall by 10^9.9 in a decade of samples is chance, not a law; a rise
  // and a constant are no convergence.
  EXPECT_FALSE(fit_power_law({{10.0, 0.2}, {1000.0, 0.02}})->holds());
  EXPECT_FALSE(fit_power_law({{4.0, 1.0}, {8.0, 1e-3}, {16.0, 1e-6}})->holds());
  EXPECT_FALSE(fit_power_law(points_of(0.3, -0.25, 0.0, 6))->holds());
  EXPECT_FALSE(fit_power_law(points_of(0.3, 0.0, 0.0, 6))->holds());
  // Residuals of factors 0.1, 10: ln 10 / (ln 4 sqrt(5)) = 0.74, more than the 0.25 allowed.
  EXPECT_FALSE(fit_power_law({{4.0, 1.0}, {16.0, 0.05}, {64.0, 1.0}, {256.0, 0.02}})->holds());
}

TEST(PowerLaw, NothingIsFittedToOnePlaceOrToZeroErrors) {
  EXPECT_FALSE(fit_power_law({}));
  EXPECT_FALSE(fit_power_law({{4.0, 0.1}}));
  EXPECT_FALSE(fit_power_law({{4.0, 0.1}, {4.0, 0.2}}));
  EXPECT_FALSE(fit_power_law({{4.0, 0.0}, {16.0, 0.1}, {64.0, 0.0}}));
}

TEST(PowerLaw, AFlatSeriesHasExponentZero) {
  const auto law = fit_power_law({{4.0, 0.3}, {16.0, 0.3}, {64.0, 0.3}, {256.0, 0.3}});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0.0, 1e-12);
  EXPECT_NEAR(law->error_at(1e6), 0.3, 1e-9);
}

TEST(PowerLaw, WhatIsNoNumberIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const ErrorAt bad : {ErrorAt{1.0, nan}, ErrorAt{nan, 1.0}, ErrorAt{0.0, 0.1},
                            ErrorAt{-1.0, 0.1}, ErrorAt{1.0, -0.1}, ErrorAt{1.0, infinite}}) {
    EXPECT_THROW((void)fit_power_law({{2.0, 0.1}, bad, {8.0, 0.05}}), base::Error);
  }
}

}  // namespace
}  // namespace earthshine::studies
