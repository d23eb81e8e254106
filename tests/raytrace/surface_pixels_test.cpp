// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/error_budget.h"
#include "tests/studies/plates.h"

namespace earthshine::raytrace {
namespace {

TEST(ErrorWeight, IsOneUpToFourTimesTheMean) {
  EXPECT_EQ(error_weight(0.0, 1.0), 1.0);
  EXPECT_EQ(error_weight(4.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(error_weight(400.0, 2.0), 0.02);
  EXPECT_EQ(error_weight(0.0, 0.0), 1.0);
}

struct View {
  tests::SceneBuilder builder = tests::plate_on_ground(0.4, 0.6);
  tests::Prepared prepared{builder.scene};
  [[nodiscard]] SurfacePixels seen(const RenderOptions& options) const {
    return {prepared, tests::above(4.0, 8.0), options};
  }
};

TEST(SurfacePixels, AreThoseThatShowAnObject) {
  // 8 m over 32 x 32 pixels: the ground is 4 m wide, 16 pixels, the plate in its middle 1 m, 4.
  RenderOptions options;
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
  RenderOptions options;
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
}  // namespace earthshine::raytrace
