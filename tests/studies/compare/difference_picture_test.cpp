// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/difference_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

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

TEST(DifferencePicture, ScaleIsNeutralInTheMiddleAndMonotoneToItsEnds) {
  // Lightness falls from the middle outward on both sides, red above and blue below.
  std::vector<float> ratios;
  for (int k = -40; k <= 40; ++k) ratios.push_back(std::pow(1.05F, static_cast<float>(k)));
  const DifferencePicture picture =
      difference_picture(grey(81, 1, ratios), grey(81, 1, std::vector<float>(81, 1.0F)));
  const auto lightness = [&](int x) {
    const Colour c = at(picture, x, 0);
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  const Colour middle = at(picture, 40, 0);
  EXPECT_EQ(middle[0], middle[1]);
  EXPECT_EQ(middle[1], middle[2]);
  for (int x = 40; x < 80; ++x) EXPECT_LE(lightness(x + 1), lightness(x)) << x;
  for (int x = 40; x > 0; --x) EXPECT_LE(lightness(x - 1), lightness(x)) << x;
  for (int x = 43; x <= 80; ++x) EXPECT_GT(at(picture, x, 0)[0], at(picture, x, 0)[2]) << x;
  for (int x = 0; x <= 37; ++x) EXPECT_GT(at(picture, x, 0)[2], at(picture, x, 0)[0]) << x;
  // Too bright and too dark by as much are about as far from white: within 35 of 255.
  for (int x = 0; x < 40; ++x) EXPECT_NEAR(lightness(x), lightness(80 - x), 35.0) << x;
  // The ends are the ends: 1.05^40 = 7 as infinity, its inverse as 0.
  const DifferencePicture ends =
      difference_picture(grey(2, 1, {1.0F, 0.0F}), grey(2, 1, {0.0F, 1.0F}));
  EXPECT_EQ(at(ends, 0, 0), at(picture, 80, 0));
  EXPECT_EQ(at(ends, 1, 0), at(picture, 0, 0));
}

TEST(DifferencePicture, CaptionStandsBelowAndTheSkyIsGrey) {
  const std::vector<float> flat(4, 1.0F);
  const ObjectMap map{2, 2, {0, 0, no_object, 0}};
  const auto captioned = [&](const std::vector<std::string>& caption) {
    return difference_picture(grey(2, 2, flat), grey(2, 2, flat), map, caption);
  };
  const DifferencePicture bare = captioned({}), one = captioned({"radiosity"});
  const Colour sky = at(one, 0, 16);  // a pixel is 16 dots wide
  EXPECT_EQ(sky[0], sky[2]);
  EXPECT_NE(sky, at(one, 0, 0));
  EXPECT_GT(one.rows, bare.rows);
  const auto ink = [](const DifferencePicture& picture, int from_row) {
    int dots = 0;
    for (int y = from_row; y < picture.rows; ++y) {
      for (int x = 0; x < picture.columns; ++x)
        dots += at(picture, x, y) == Colour{0, 0, 0} ? 1 : 0;
    }
    return dots;
  };
  // r 9, a 14, d 14, i 8, o 12, s 11, i 8, t 11, y 12 dots.
  EXPECT_GT(ink(one, bare.rows), 80);
  // Words are broken at blanks, and none is lost.
  const DifferencePicture many = captioned({std::string(40, 'x') + " " + std::string(40, 'x')});
  EXPECT_EQ(many.rows, one.rows + 10);
  EXPECT_EQ(ink(many, bare.rows), 2 * ink(captioned({std::string(40, 'x')}), bare.rows));
}

TEST(DifferencePicture, TallPictureKeepsItsHeight) {
  const std::vector<float> flat(800, 1.0F);
  const DifferencePicture picture = difference_picture(grey(2, 400, flat), grey(2, 400, flat));
  EXPECT_EQ(picture.rows, 400);
  EXPECT_GT(picture.columns, 2);
}

}  // namespace
}  // namespace earthshine::studies
