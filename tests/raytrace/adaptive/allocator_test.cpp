// SPDX-License-Identifier: Apache-2.0
// Rounds of samples toward a wanted error, for synthetic pixel sums.
#include "raytrace/adaptive/allocator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace earthshine::raytrace {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

// A grey picture of mean luminance 1. Every pixel has 1024 samples of variance 1 to 3.5, each with
// one ray; one more pixel has 4 samples of variance 3.
PixelSums surprised() {
  constexpr double few = 4.0, many = 1024.0, bad = 3.0;
  PixelSums sums(Window{0, 0, 16, 16}, 1, false);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    const double n = p == 0 ? few : many, variance = p == 0 ? bad : 1.0 + 0.01 * double(p);
    sums.samples[p] = static_cast<std::uint32_t>(n);
    sums.rays[p] = static_cast<float>(n);
    sums.radiance[p] = glm::vec3(float(n));
    sums.luminance[p] = n;
    sums.luminance2[p] = n + variance * (n - 1.0);
    sums.half_difference[p] = std::sqrt(variance * n);
    sums.source[p].reflecting = n;
  }
  return sums;
}

// The noisy pixel has half of the squared error. Twelve more samples there, 1/20 000 of all, would
// suffice for a round: at that pace it would take a hundred rounds to double the samples.
TEST(Allocator, NoneCostsNextToNothing) {
  const PixelSums sums = surprised();
  SamplePlanner planner(sums, nullptr, {});
  const double so_far = spent(sums, nullptr, {});
  EXPECT_LT(planner.plan(0.7 * planner.squared_error(), no_limit).cost, 1e-3 * so_far);
  Allocator rounds = Allocator::to_error(0.001);
  const auto plan = rounds.next(planner, so_far, no_limit);
  ASSERT_TRUE(plan.has_value());
  EXPECT_GT(plan->cost, 0.01 * so_far);
}

TEST(Allocator, NoneCostsMoreThanCanBeAfforded) {
  const PixelSums sums = surprised();
  SamplePlanner planner(sums, nullptr, {});
  const double so_far = spent(sums, nullptr, {});
  Allocator rounds = Allocator::to_error(0.001);
  const auto plan = rounds.next(planner, so_far, 1e-3 * so_far);
  ASSERT_TRUE(plan.has_value());
  EXPECT_LE(plan->cost, 1e-3 * so_far);
  EXPECT_FALSE(rounds.gave_up());
}

// Nearly equal pixels, with 1024 samples each.
PixelSums alike() {
  PixelSums sums = surprised();
  sums.samples[0] = 1024;
  sums.rays[0] = 1024.0F;
  sums.radiance[0] = glm::vec3(1024.0F);
  sums.luminance[0] = sums.source[0].reflecting = 1024.0;
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    const double variance = 1.0 + 1e-4 * double(p);
    sums.luminance2[p] = 1024.0 + variance * 1023.0;
    sums.half_difference[p] = std::sqrt(variance * 1024.0);
  }
  return sums;
}

// A quarter of the squared error takes four times the samples, by 1 / N and by the plan. A
// sixteenth takes sixteen times the samples; a plan, which at most quadruples a point's samples,
// gives the first step only.
TEST(Allocator, GrowthIsThatOfThePlanAndBeyondItOfTheSquare) {
  const PixelSums sums = alike();
  SamplePlanner planner(sums, nullptr, {});
  const double so_far = spent(sums, nullptr, {});
  const double half = 0.5 * std::sqrt(planner.squared_error());
  const auto growth = [&](double aimed) {
    return Allocator::to_error(planner.confidence_factor() * aimed / tuning::planned_share)
        .growth(planner, so_far);
  };
  EXPECT_NEAR(growth(half), 4.0, 0.02);
  EXPECT_NEAR(growth(0.5 * half), 16.0, 0.1);
  EXPECT_EQ(growth(4.0 * half), 1.0);
}

// Every pixel has the same number of samples with variance 1 and mean 1: its error is 1 / sqrt(n).
PixelSums off_by(double error) {
  PixelSums sums(Window{0, 0, 16, 16}, 1, false);
  const double n = std::round(1.0 / (error * error));
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    sums.samples[p] = static_cast<std::uint32_t>(n);
    sums.rays[p] = static_cast<float>(n);
    sums.radiance[p] = glm::vec3(float(n));
    sums.luminance[p] = n;
    sums.luminance2[p] = n + (n - 1.0);
    sums.half_difference[p] = std::sqrt(n);
    sums.source[p].reflecting = n;
  }
  return sums;
}

// True errors of coarse pictures are at most 1.06 of the stated ones, of fine pictures up to 1.1.
// For a wanted error of 5 %, a stated 4.6 is enough and 4.8 is not; for 3 %, 2.65 is enough and
// 2.76 is not. The stop fraction does not apply to the initial samples, which follow no statement.
// Each of 256 pixels has one difference d, all equal here: the sum of 2/3 d^4 is 2/3 / 256 of the
// squared sum of d^2, and 1.2816 of its root enters the confidence factor.
const double factor_of_256 = std::sqrt(1.0 + 1.2816 * std::sqrt(2.0 / 3.0 / 256.0));
TEST(Allocator, GoOnUntilTheErrorIsSure) {
  const auto goes_on = [](double wanted, double first, double second) {
    Allocator rounds = Allocator::to_error(wanted);
    for (const double error : {first / factor_of_256, second / factor_of_256}) {
      const PixelSums sums = off_by(error);
      SamplePlanner planner(sums, nullptr, {});
      // Half a sample, the rounding of n, changes 1 / sqrt(n) by n^(-3/2) / 4.
      EXPECT_NEAR(std::sqrt(planner.squared_error()), error, 0.26 * error * error * error);
      const bool more = rounds.next(planner, spent(sums, nullptr, {}), no_limit).has_value();
      if (!more) return false;
    }
    return true;
  };
  EXPECT_FALSE(goes_on(0.05, 0.1, 0.046));
  EXPECT_TRUE(goes_on(0.05, 0.1, 0.048));
  EXPECT_FALSE(goes_on(0.03, 0.1, 0.0265));
  EXPECT_TRUE(goes_on(0.03, 0.1, 0.0276));
  EXPECT_FALSE(goes_on(0.05, 0.0499, 0.0499));
}

// Each round costs a denoising step and an error statement. A round aims at a quarter of the
// squared error, for three times the samples so far, and no further, since predictions from few
// samples are rough.
TEST(Allocator, OneGoesToAQuarterOfTheSquaredError) {
  const PixelSums sums = alike();
  SamplePlanner planner(sums, nullptr, {});
  const double so_far = spent(sums, nullptr, {});
  const double half = 0.5 * std::sqrt(planner.squared_error());
  for (const double aimed : {half, 0.1 * half}) {
    const auto plan =
        Allocator::to_error(planner.confidence_factor() * aimed / tuning::planned_share)
            .next(planner, so_far, no_limit);
    ASSERT_TRUE(plan.has_value());
    EXPECT_NEAR(plan->cost, 3.0 * so_far, 0.1 * so_far);
  }
}

// Noise of the residual may make the mean negative. No wanted error is reached then: the error is
// stated as 200 %.
TEST(Allocator, APictureThatNoiseLeavesNothingOfGoesOn) {
  PixelSums sums = surprised();
  for (glm::vec3& light : sums.radiance) light = -light;
  SamplePlanner planner(sums, nullptr, {});
  EXPECT_NEAR(planner.squared_error(), 4.0, 1e-12);
  EXPECT_TRUE(
      Allocator::to_error(1.0).next(planner, spent(sums, nullptr, {}), no_limit).has_value());
  // Nor if the whole error is in one bright pixel, which has full weight.
  sums.radiance[0] = glm::vec3(1e4F * 4.0F);
  sums.radiance[1] = glm::vec3(-1e5F * 1024.0F);
  sums.half_difference[0] = 1000.0 * 4.0;
  EXPECT_NEAR(SamplePlanner(sums, nullptr, {}).squared_error(), 4.0, 1e-12);
}

// All light comes straight from a source, up to the rounding of sums: there is no error.
TEST(Allocator, RoundingOfASourceIsNoLightThatIsMissing) {
  PixelSums sums = surprised();
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    sums.source[p].luminance = double(sums.radiance[p].x) * (1.0 + 1e-7);
    sums.half_difference[p] = 0.0;
  }
  SamplePlanner planner(sums, nullptr, {});
  EXPECT_EQ(planner.squared_error(), 0.0);
  EXPECT_FALSE(
      Allocator::to_error(0.05).next(planner, spent(sums, nullptr, {}), no_limit).has_value());
}

// All initial samples at 4 % and below; half of them above 4 %, and without a wanted error.
TEST(Allocator, InitialSamplingIsAsCoarseAsThePicture) {
  constexpr std::size_t points = 256 * 256;
  const InitialSampling full = Allocator::to_error(0.04).initial(points);
  for (const double wanted : {0.041, 0.5, 0.0}) {
    const InitialSampling half = Allocator::to_error(wanted).initial(points);
    EXPECT_EQ(2 * half.gather_rays, full.gather_rays);
    EXPECT_EQ(2 * half.paths, full.paths);
  }
  EXPECT_EQ(Allocator::to_error(0.01).initial(points).paths, full.paths);
}

// At half of the points if the picture is coarse, provided they have 2^16 paths.
TEST(Allocator, InitialSamplingAtEverySecondPointIsOfManyPointsAlone) {
  EXPECT_TRUE(Allocator::to_error(0.05).initial(1U << 16U).every_second);
  EXPECT_FALSE(Allocator::to_error(0.05).initial((1U << 16U) - 1).every_second);
  EXPECT_FALSE(Allocator::to_error(0.04).initial(1U << 20U).every_second);
}

// Light that one of ten thousand paths finds: 2^15 paths all miss it with a probability of
// exp(-3.3) = 4 %, however few the points.
TEST(Allocator, InitialSamplingOfFewPointsIsOfManyPaths) {
  for (const std::size_t points : {std::size_t{1}, std::size_t{256}, std::size_t{5000}}) {
    EXPECT_GT(Allocator::to_error(0.5).initial(points).paths * points, 32768U);
  }
}

// Fixed numbers are the same at edges and elsewhere, and no rounds follow.
TEST(Allocator, FixedNumbersHaveNoRounds) {
  Allocator fixed = Allocator::fixed(64, 16);
  const InitialSampling initial = fixed.initial(5);
  EXPECT_EQ(initial.field(), (std::array{64U, 32U, 32U}));
  EXPECT_EQ(initial.camera, 16);
  EXPECT_EQ(initial.interior, 16);
  EXPECT_FALSE(initial.every_second);
  EXPECT_FALSE(fixed.has_rounds());
  const PixelSums sums = surprised();
  SamplePlanner planner(sums, nullptr, {});
  EXPECT_FALSE(fixed.next(planner, spent(sums, nullptr, {}), no_limit).has_value());
}

// If the samples include all noise, 1024 times as many reduce the error to 1/32.
TEST(Allocator, AnErrorThatWillNotFallIsHopeless) {
  EXPECT_FALSE(Allocator::is_hopeless({{1.0, 0.1}}));
  EXPECT_TRUE(Allocator::is_hopeless({{1.0, 0.1}, {1024.0, 0.06}}));
  EXPECT_FALSE(Allocator::is_hopeless({{1.0, 0.1}, {1000.0, 0.1}}));
  EXPECT_FALSE(Allocator::is_hopeless({{1.0, 0.1}, {1024.0, 0.05}}));
}

// An error that the initial sampling missed counts from the statement that found it.
TEST(Allocator, ASurpriseIsNotHopeless) {
  EXPECT_FALSE(Allocator::is_hopeless({{1.0, 0.1}, {4.0, 0.8}, {4096.0, 0.3}}));
}

}  // namespace
}  // namespace earthshine::raytrace
