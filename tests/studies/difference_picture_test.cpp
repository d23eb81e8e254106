// SPDX-License-Identifier: Apache-2.0
#include "studies/difference_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace earthshine::studies {
namespace {

base::Image grey(int columns, int rows, const std::vector<float>& luminance) {
  base::Image image = base::make_rgb_image(columns, rows);
  for (base::Channel& channel : image.channels) channel.values = luminance;
  return image;
}

using Colour = std::array<std::uint8_t, 3>;
Colour at(const DifferencePicture& picture, int x, int y) {
  const auto i = 3 * static_cast<std::size_t>(y * picture.columns + x);
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

TEST(DifferencePicture, EachBandOfTheRatioHasItsColour) {
  const std::vector<float> ratios = {9.0F, 3.0F, 1.8F, 1.2F, 1.0F, 0.8F, 0.6F, 0.3F, 0.1F};
  const DifferencePicture picture =
      difference_picture(grey(9, 1, ratios), grey(9, 1, std::vector<float>(9, 1.0F)));
  std::set<Colour> colours;
  for (int x = 0; x < 9; ++x) colours.insert(at(picture, x, 0));
  EXPECT_EQ(colours.size(), 9U);
  const Colour brighter = at(picture, 0, 0), darker = at(picture, 8, 0);
  EXPECT_GT(brighter[0], brighter[2]);  // red
  EXPECT_GT(darker[2], darker[0]);      // blue
}

TEST(DifferencePicture, ScaleShowsTheSameColoursFromTopToBottom) {
  const std::vector<float> ratios = {9.0F, 3.0F, 1.8F, 1.2F, 1.0F, 0.8F, 0.6F, 0.3F, 0.1F};
  const DifferencePicture picture =
      difference_picture(grey(9, 1, ratios), grey(9, 1, std::vector<float>(9, 1.0F)));
  ASSERT_EQ(picture.rgb.size(), 3U * static_cast<std::size_t>(picture.columns * picture.rows));
  EXPECT_EQ(picture.rows % 9, 0);
  const int box = picture.rows / 9;
  for (int band = 0; band < 9; ++band) {
    EXPECT_EQ(at(picture, 9 + 10, band * box + box / 2), at(picture, band, 0));
  }
}

TEST(DifferencePicture, BlackAgainstBlackIsNoDifference) {
  const DifferencePicture picture =
      difference_picture(grey(4, 1, {0, 5, 1, 0}), grey(4, 1, {0, 5, 0, 1}));
  EXPECT_EQ(at(picture, 0, 0), at(picture, 1, 0));
  EXPECT_NE(at(picture, 2, 0), at(picture, 3, 0));
  EXPECT_GT(at(picture, 2, 0)[0], at(picture, 2, 0)[2]);
}

TEST(DifferencePicture, TallPictureKeepsItsHeight) {
  const std::vector<float> flat(800, 1.0F);
  const DifferencePicture picture = difference_picture(grey(2, 400, flat), grey(2, 400, flat));
  EXPECT_EQ(picture.rows, 400);
  EXPECT_GT(picture.columns, 2);
}

}  // namespace
}  // namespace earthshine::studies
