// SPDX-License-Identifier: Apache-2.0
// Allocation of further camera samples, for synthetic pixel sums.
#include "raytrace/adaptive/sample_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {
namespace {

constexpr int edge = 16;
constexpr double no_limit = std::numeric_limits<double>::infinity();

// A noise-free grey picture of mean luminance 1. Every pixel has the same number of samples, each
// with one ray.
PixelSums quiet(std::uint32_t samples) {
  PixelSums sums(Window{0, 0, edge, edge}, 1, false);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    sums.samples[p] = samples;
    sums.rays[p] = static_cast<float>(samples);
    sums.radiance[p] = glm::vec3(float(samples));
    sums.luminance[p] = sums.luminance2[p] = samples;
    sums.source[p].reflecting = samples;
  }
  return sums;
}

// Gives a pixel samples of that variance. `alike`: squared difference of the halves, relative to
// independent samples.
void disturb(PixelSums& sums, std::size_t pixel, double variance, double alike = 1.0) {
  const double n = sums.samples[pixel];
  sums.luminance2[pixel] = n + variance * (n - 1.0);
  sums.half_difference[pixel] = std::sqrt(alike * variance * n);
}

SamplePlan plan(const PixelSums& sums, double squared_error, double most_cost = no_limit) {
  return SamplePlanner(sums, nullptr, {}).plan(squared_error, most_cost);
}

TEST(SamplePlan, FewSamplesAreToldByTheNoisiestAround) {
  PixelSums sums = quiet(4);
  const std::size_t noisy = sums.window.index(8, 8), beside = sums.window.index(9, 8);
  disturb(sums, noisy, 1.0);
  const SamplePlan few = plan(sums, 0.0);
  EXPECT_GT(few.camera[noisy], 4U);
  EXPECT_EQ(few.camera[beside], few.camera[noisy]);
  EXPECT_EQ(few.camera[sums.window.index(2, 2)], 4U);
}

// All samples left of an edge are 1, all right of it 3. Two samples in a pixel may both miss the
// part beyond the edge. If the edge is in this pixel or in the next with equal probability, and the
// part beyond it has the share f, uniform, the error is f (3 - 1) with the probability (1 - f)^2:
//   4 * 1/2 * integral of f^2 (1 - f)^2 = 4 / 60.
// Pixels with an error larger by a tenth come first; pixels with one smaller by a tenth do not.
TEST(SamplePlan, ContrastTellsOfAnEdgeThatSamplesMissed) {
  constexpr double missed = 4.0 / 60.0;
  constexpr double each = 2.0 * 2.0;  // doubled samples, each with a ray
  for (const double noise : {0.9, 1.1}) {
    PixelSums sums = quiet(2);
    for (std::size_t p = 0; p < sums.samples.size(); ++p) {
      if (p % edge < edge / 2) continue;
      sums.radiance[p] *= 3.0F;
      sums.luminance[p] *= 3.0;
      sums.luminance2[p] *= 9.0;
    }
    disturb(sums, sums.window.index(2, 2), 2.0 * noise * missed);
    const SamplePlan next = plan(sums, 0.0, 2.0 * edge * each);
    EXPECT_EQ(next.camera[sums.window.index(2, 2)], noise > 1.0 ? 4U : 2U);
    for (const int x : {7, 8}) {
      EXPECT_EQ(next.camera[sums.window.index(x, 9)], noise > 1.0 ? 2U : 4U);
    }
    EXPECT_EQ(next.camera[sums.window.index(9, 9)], 2U);
  }
}

// With so small an error and so expensive samples that the price of a ray underflows in single
// precision, pixels without an error still get no samples.
TEST(SamplePlan, NoErrorIsTooSmallToTellWhoNeedsNothing) {
  constexpr double dim = 4e-19;  // its square is still a normal number
  PixelSums sums = quiet(4);
  std::fill(sums.rays.begin(), sums.rays.end(), 1e6F);
  const std::size_t noisy = sums.window.index(8, 8);
  sums.radiance[noisy] = glm::vec3(float(4.0 * dim));
  sums.luminance[noisy] = 4.0 * dim;
  sums.luminance2[noisy] = 8.0 * dim * dim;
  sums.half_difference[noisy] = 2.0 * dim;
  EXPECT_GT(SamplePlanner(sums, nullptr, {}).squared_error(), 0.0);
  const SamplePlan least = plan(sums, 0.0);
  EXPECT_EQ(least.camera[sums.window.index(2, 2)], 4U);
}

// With 256 samples, missed parts cover less than 1/64 of a pixel. Half of the picture's squared
// error disappears when only the noisy pixel doubles its samples.
TEST(SamplePlan, ManySamplesSpeakForThemselves) {
  PixelSums sums = quiet(256);
  const std::size_t noisy = sums.window.index(8, 8);
  disturb(sums, noisy, 1.0);
  const double now = SamplePlanner(sums, nullptr, {}).squared_error();
  EXPECT_NEAR(now, 1.0 / 256.0 / (edge * edge), 1e-12);  // variance / n, over all pixels
  const SamplePlan many = plan(sums, 0.5 * now);
  EXPECT_EQ(many.camera[noisy], 512U);
  EXPECT_EQ(many.camera[sums.window.index(9, 8)], 256U);
}

// Both halves of the picture have equal noise; samples of the left half take ten rays each, those
// of the right half one. A budget of a tenth of the cost goes to the right half.
TEST(SamplePlan, CheapSamplesComeFirst) {
  PixelSums sums = quiet(64);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    disturb(sums, p, 1.0);
    if (p % edge < edge / 2) sums.rays[p] *= 10.0F;
  }
  const double each_right = 64.0 * 2.0;  // a sample and a ray
  const SamplePlan cheap = plan(sums, 0.0, edge * edge / 2 * each_right);
  EXPECT_EQ(cheap.camera[sums.window.index(2, 8)], 64U);
  EXPECT_EQ(cheap.camera[sums.window.index(13, 8)], 128U);
}

// In the lower half, 1024 samples of variance 16384 would gain four times as much for their price
// as 16 of variance 1 in the upper half (variance / samples^2), if they were independent. But the
// variance of their means is a hundred times less (an edge resolved by low-discrepancy samples):
// they gain 25 times less.
TEST(SamplePlan, SamplesThatScatterLessTogetherNeedFewer) {
  PixelSums sums = quiet(16);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    if (p / edge < edge / 2) {
      disturb(sums, p, 1.0);
      continue;
    }
    sums.samples[p] = 1024;
    sums.rays[p] = 1024.0F;
    sums.radiance[p] = glm::vec3(1024.0F);
    sums.luminance[p] = 1024.0;
    sums.source[p].reflecting = 1024.0;
    disturb(sums, p, 16384.0, 0.01);
  }
  const SamplePlan next = plan(sums, 0.0, 3.0 * 16.0 * 2.0 * edge * edge / 2);
  EXPECT_EQ(next.camera[sums.window.index(8, 2)], 64U);
  EXPECT_EQ(next.camera[sums.window.index(8, 13)], 1024U);
}

// A deviation is visible against the pixel's own luminance, or against dimmest_share of the mean in
// darker pixels. Beyond visible_deviation of that, pixels get four times their samples, the worst
// first and no more than the cost allows; the others get none.
TEST(SamplePlan, SpecksAreDeviationsThatAPixelsLightDoesNotHide) {
  constexpr double n = 16.0, dark = 0.2;
  struct Row {
    int x;
    double luminance, deviation;  // of the mean, over the threshold
    bool is_speck;
  };
  const Row rows[] = {{1, 1.0, 0.9, false}, {3, 1.0, 1.1, true},  {5, dark, 0.9, false},
                      {7, dark, 1.1, true}, {9, 0.0, 0.9, false}, {11, 0.0, 1.2, true}};
  PixelSums sums = quiet(16);
  for (const Row& row : rows) {
    const std::size_t p = sums.window.index(row.x, 8);
    sums.radiance[p] = glm::vec3(float(n * row.luminance));
    sums.luminance[p] = n * row.luminance;
  }
  double mean = 0.0;
  for (const double sum : sums.luminance) mean += sum / n / (edge * edge);
  for (const Row& row : rows) {
    const std::size_t p = sums.window.index(row.x, 8);
    const double against = std::max(row.luminance, tuning::dimmest_share * mean);
    const double deviation = row.deviation * tuning::visible_deviation * against;
    sums.luminance2[p] = n * row.luminance * row.luminance + n * deviation * deviation * (n - 1.0);
    sums.half_difference[p] = deviation * n;
  }
  const SamplePlanner planner(sums, nullptr, {});
  const SamplePlan all = planner.plan_for_specks(no_limit);
  for (const Row& row : rows) {
    EXPECT_EQ(all.camera[sums.window.index(row.x, 8)], row.is_speck ? 64U : 16U) << row.x;
  }
  EXPECT_EQ(std::ranges::count(all.camera, 16U), edge * edge - 3);
  EXPECT_EQ(all.cost, 3.0 * 3.0 * 16.0 * 2.0);  // three pixels, three times 16 samples with a ray
  const SamplePlan worst = planner.plan_for_specks(1.0);
  EXPECT_EQ(worst.camera[sums.window.index(11, 8)], 64U);
  EXPECT_EQ(std::ranges::count(worst.camera, 16U), edge * edge - 1);
}

}  // namespace
}  // namespace earthshine::raytrace
