// SPDX-License-Identifier: Apache-2.0
#include "studies/pixel_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

TEST(SpreadByWeight, EachIsChosenAsOftenAsItDeserves) {
  const std::vector<double> weights{1.0, 0.0, 3.5, 0.25, 7.0, 0.0, 0.25};
  constexpr std::size_t count = 5;
  constexpr int times = 4000;
  std::vector<double> chosen(weights.size(), 0.0);
  for (std::uint64_t seed = 0; seed < times; ++seed) {
    std::vector<int> now(weights.size(), 0);
    for (const std::size_t k : spread_by_weight(weights, count, seed)) ++now[k];
    EXPECT_EQ(std::accumulate(now.begin(), now.end(), 0), int{count});
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double deserved = count * weights[k] / 12.0;
      EXPECT_GE(now[k], std::floor(deserved));
      EXPECT_LE(now[k], std::ceil(deserved));
      chosen[k] += now[k] / double(times);
    }
  }
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double deserved = count * weights[k] / 12.0, part = deserved - std::floor(deserved);
    EXPECT_NEAR(chosen[k], deserved, 4.0 * std::sqrt(part * (1.0 - part) / times)) << k;
  }
}

TEST(SpreadByWeight, NothingIsChosenOfNothing) {
  const std::vector<double> black(4, 0.0), lit(4, 1.0);
  EXPECT_TRUE(spread_by_weight(black, 3, 1).empty());
  EXPECT_TRUE(spread_by_weight({}, 3, 1).empty());
  EXPECT_TRUE(spread_by_weight(lit, 0, 1).empty());
}

TEST(ErrorWeight, IsOneUpToFourTimesTheMean) {
  EXPECT_EQ(raytrace::error_weight(0.0, 1.0), 1.0);
  EXPECT_EQ(raytrace::error_weight(4.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(raytrace::error_weight(400.0, 2.0), 0.02);
  EXPECT_EQ(raytrace::error_weight(0.0, 0.0), 1.0);
}

TEST(SpreadEvenly, OneOfEachRunAndAllAlike) {
  std::vector<std::uint32_t> pixels(103);
  std::iota(pixels.begin(), pixels.end(), 1000U);
  constexpr std::size_t count = 10;
  constexpr int times = 5000;
  std::vector<double> chosen(pixels.size(), 0.0);
  for (std::uint64_t seed = 0; seed < times; ++seed) {
    const auto some = spread_evenly(pixels, count, seed);
    ASSERT_EQ(some.size(), count);
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_GE(some[k], 1000 + k * 103 / count);
      EXPECT_LT(some[k], 1000 + (k + 1) * 103 / count);
      chosen[some[k] - 1000] += 1.0 / times;
    }
  }
  // Runs of 10 and three of 11.
  for (const double share : chosen) {
    EXPECT_NEAR(share, 0.0955, 0.0046 + 4.0 * std::sqrt(0.1 * 0.9 / times));
  }
  EXPECT_EQ(spread_evenly(pixels, 103, 1), pixels);
  EXPECT_EQ(spread_evenly(pixels, 500, 1), pixels);
  EXPECT_TRUE(spread_evenly({}, 500, 1).empty());
}

struct View {
  tests::SceneBuilder builder = tests::plate_on_ground(0.4, 0.6);
  tests::Prepared prepared{builder.scene};
  [[nodiscard]] SurfacePixels seen(const raytrace::RenderOptions& options) const {
    return {{builder.scene, prepared.groups, prepared.effects, prepared.query},
            tests::above(4.0, 8.0),
            options};
  }
};

TEST(SurfacePixels, AreThoseThatShowAnObject) {
  // 8 m over 32 x 32 pixels: the ground is 4 m wide, 16 pixels, the plate in its middle 1 m, 4.
  raytrace::RenderOptions options;
  options.columns = options.rows = 32;
  const SurfacePixels seen = View().seen(options);
  EXPECT_EQ(seen.all().size(), 256U);
  EXPECT_TRUE(std::is_sorted(seen.all().begin(), seen.all().end()));
  const std::vector<std::uint32_t> plate = seen.of_object(1);
  ASSERT_EQ(plate.size(), 16U);
  EXPECT_EQ(plate.front(), 14U * 32 + 14);
  EXPECT_EQ(plate.back(), 17U * 32 + 17);
  EXPECT_EQ(seen.of_object(0).size(), 240U);
  EXPECT_TRUE(seen.of_object(2).empty());
  EXPECT_EQ(seen.in_window(plate.front()), plate.front());
  EXPECT_EQ(seen.rays(), 1024U);
}

TEST(SurfacePixels, KeepTheirNumbersInACrop) {
  raytrace::RenderOptions options;
  options.columns = options.rows = 32;
  options.crop = {10, 15, 5, 4};
  const SurfacePixels seen = View().seen(options);
  EXPECT_EQ(seen.all().size(), 20U);
  EXPECT_EQ(seen.all().front(), 15U * 32 + 10);
  EXPECT_EQ(seen.in_window(15 * 32 + 10), 0U);
  EXPECT_EQ(seen.in_window(18 * 32 + 14), 19U);
  EXPECT_EQ(seen.of_object(1),
            (std::vector<std::uint32_t>{15 * 32 + 14, 16 * 32 + 14, 17 * 32 + 14}));
  EXPECT_EQ(seen.rays(), 20U);
}

}  // namespace
}  // namespace earthshine::studies
