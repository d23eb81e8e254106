// SPDX-License-Identifier: Apache-2.0
#include "base/files/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"

namespace earthshine::base {
namespace {

double covered(const std::vector<float>& coverage) {
  return std::accumulate(coverage.begin(), coverage.end(), 0.0);
}

TEST(Overlay, LineThroughPixelCentresFillsThemAndOnlyThem) {
  const std::vector<Line> lines = {{2.5, 3.5, 7.5, 3.5}};
  const auto coverage = line_coverage(10, 8, lines, 1.0);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 10; ++x) {
      const bool on = y == 3 && x >= 2 && x <= 7;
      EXPECT_EQ(coverage[static_cast<std::size_t>(y * 10 + x)], on ? 1.0F : 0.0F) << x << " " << y;
    }
  }
}

TEST(Overlay, LineHasItsWidthAtAnyPlaceAndAngle) {
  // Area: length x width plus the two round ends, whose fall-off over a pixel's width at the radius
  // integrates to pi (w^2/4 + 1/12). Sampling at pixel centres has an error of some percent.
  constexpr double width = 3.0;
  for (double angle = 0.0; angle < 3.1; angle += 0.29) {
    const double dx = 40.0 * std::cos(angle), dy = 40.0 * std::sin(angle);
    const std::vector<Line> lines = {{50.3 - dx, 50.8 - dy, 50.3 + dx, 50.8 + dy}};
    const double exact = 80.0 * width + 3.14159265 * (width * width / 4 + 1.0 / 12.0);
    EXPECT_NEAR(covered(line_coverage(100, 100, lines, width)) / exact, 1.0, 0.02) << angle;
  }
}

TEST(Overlay, EndsOutsideThePictureAndPointsAreFine) {
  const std::vector<Line> lines = {
      {-1e4, 4.5, 1e4, 4.5}, {5.5, -50.0, 5.5, 50.0}, {1.5, 1.5, 1.5, 1.5}};
  const auto coverage = line_coverage(10, 10, lines, 1.0);
  EXPECT_DOUBLE_EQ(covered(coverage), 10.0 + 10.0 - 1.0 + 1.0);
}

TEST(Overlay, CrossingsAreNoDenserThanLines) {
  const std::vector<Line> lines = {{0, 5, 10, 5}, {5, 0, 5, 10}, {0, 5, 10, 5}};
  for (const float c : line_coverage(10, 10, lines, 2.0)) EXPECT_LE(c, 1.0F);
  Picture8 picture{10, 10, std::vector<std::uint8_t>(300, 100)};
  paint(picture, line_coverage(10, 10, lines, 2.0), {200, 100, 0}, 0.5);
  EXPECT_EQ(picture.rgb[3 * 55], 150);      // half way to 200
  EXPECT_EQ(picture.rgb[3 * 55 + 1], 100);  // no change
  EXPECT_EQ(picture.rgb[3 * 55 + 2], 50);
  EXPECT_EQ(picture.rgb[0], 100);
}

TEST(Overlay, BlendIsTheWeightedMean) {
  Picture8 picture{2, 1, {0, 100, 200, 255, 255, 255}};
  const std::vector<std::uint8_t> over = {100, 100, 100, 0, 0, 0};
  Picture8 none = picture, all = picture;
  blend(none, over, 0.0);
  blend(all, over, 1.0);
  blend(picture, over, 0.25);
  EXPECT_EQ(none.rgb, (std::vector<std::uint8_t>{0, 100, 200, 255, 255, 255}));
  EXPECT_EQ(all.rgb, over);
  EXPECT_EQ(picture.rgb, (std::vector<std::uint8_t>{25, 100, 175, 191, 191, 191}));
  EXPECT_THROW(blend(picture, std::span(over).first(3), 0.5), Error);
}

}  // namespace
}  // namespace earthshine::base
