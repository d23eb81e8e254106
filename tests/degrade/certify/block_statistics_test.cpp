// SPDX-License-Identifier: Apache-2.0
#include "degrade/certify/block_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/parts/noise.h"
#include "degrade/stage/axis_map.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

TEST(BlockStatistics, BlocksAreWholeAndClearOfTheBorder) {
  const std::vector<Block> blocks = cut_blocks(50, 33, 4, 10);
  EXPECT_EQ(blocks.size(), 4U * 2U);  // 42 x 25 inside the border
  for (const Block& block : blocks) {
    EXPECT_GE(block.x0, 4);
    EXPECT_GE(block.y0, 4);
    EXPECT_LE(block.x1, 46);
    EXPECT_LE(block.y1, 29);
    EXPECT_EQ((block.x1 - block.x0) * (block.y1 - block.y0), 100);
  }
}

// 1, 2, 3, 6: mean 3, sample variance 14 / 3, error sqrt(14 / 3 / 4).
TEST(BlockStatistics, MeanAndItsError) {
  const Estimate mean = mean_of({1.0, 2.0, 3.0, 6.0});
  EXPECT_DOUBLE_EQ(mean.value, 3.0);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(14.0 / 12.0));
}

// Two-sided quantiles of Student's t at the probability of four deviations, 6.334e-5.
TEST(BlockStatistics, FewBlocksWidenFourErrorsAsStudentsTDoes) {
  EXPECT_DOUBLE_EQ(four_errors({1.0, 0.5}), 2.0);
  constexpr std::pair<double, double> quantiles[] = {
      {10.0, 6.5672}, {23.0, 4.8767}, {300.0, 4.0574}};
  for (const auto& [freedom, t] : quantiles) {
    EXPECT_NEAR(four_errors({1.0, 1.0, freedom}), t, 0.03 * t) << freedom;
  }
}

// Numerators exactly proportional to denominators have no error.
TEST(BlockStatistics, ProportionalSumsHaveARatioWithoutError) {
  const Estimate ratio = ratio_of({2.0, 4.0, 10.0}, {1.0, 2.0, 5.0});
  EXPECT_DOUBLE_EQ(ratio.value, 2.0);
  EXPECT_DOUBLE_EQ(ratio.error, 0.0);
}

// Grain of sigma 1 increases the error of the mean by sqrt(sum over shifts of rho) = 2 sigma
// sqrt(pi) = 3.5 compared with independent resels; blocks include this.
TEST(BlockStatistics, ErrorsKnowThatGrainIsNotIndependent) {
  const Picture noise = add_read_noise(test::flat(400, 400, 0.0F), {.a = 1.0}, {});
  const AxisMap blur = gaussian_blur(400, 1.0);
  const Picture grain = apply(noise, blur, blur);
  const std::vector<Block> blocks = cut_blocks(400, 400, 10, 20);
  const auto error_of_mean = [&](const Picture& picture) {
    std::vector<double> means;
    for (const Block& block : blocks) {
      means.push_back(block_mean(
          block, 400, [&](std::size_t i) { return static_cast<double>(picture.planes[0][i]); }));
    }
    return mean_of(means).error;
  };
  const double count = 361.0 * 400.0;
  // Blur does not change the error of the mean; it reduces the deviation by the same factor.
  EXPECT_NEAR(error_of_mean(noise) * std::sqrt(count), 1.0, 4.0 / std::sqrt(2.0 * 361.0));
  EXPECT_NEAR(error_of_mean(grain) * std::sqrt(count), 1.0, 4.0 / std::sqrt(2.0 * 361.0) + 0.06);
}

TEST(BlockStatistics, CorrelationOfAFieldWithItselfIsOneAndShiftedIsThatOfTheTaps) {
  const Picture noise = add_read_noise(test::flat(200, 200, 0.0F), {.a = 1.0}, {});
  const std::vector<Block> blocks = cut_blocks(200, 200, 4, 12);
  EXPECT_DOUBLE_EQ(correlation(noise, noise, blocks).value, 1.0);
  // Means of two neighbours have the correlation 1/2.
  Picture pairs = noise;
  for (std::size_t i = 0; i + 1 < pairs.planes[0].size(); ++i) {
    pairs.planes[0][i] = 0.5F * (noise.planes[0][i] + noise.planes[0][i + 1]);
  }
  const Estimate next = correlation(pairs, pairs, blocks, 1, 0);
  EXPECT_NEAR(next.value, 0.5, 4.0 * next.error);
  // Bartlett: variance (1 + 2 rho^2 - ...) / n, about 1/2 to 1 of the variance for an independent
  // field.
  EXPECT_NEAR(next.error, 0.7 / 190.0, 0.35 / 190.0);
  const Estimate across = correlation(pairs, pairs, blocks, 0, 1);
  EXPECT_NEAR(across.value, 0.0, 4.0 * across.error);
}

}  // namespace
}  // namespace earthshine::degrade
