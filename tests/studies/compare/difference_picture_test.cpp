// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "studies/compare/target_differences.h"

namespace earthshine::studies {
namespace {

base::Image grey(const std::vector<float>& luminance) {
  base::Image image = base::make_rgb_image(static_cast<int>(luminance.size()), 1);
  for (base::Channel& channel : image.channels) channel.values = luminance;
  return image;
}

std::vector<Colour> colours_of(const std::vector<float>& luminance,
                               const std::vector<float>& reference,
                               std::vector<std::int32_t> object = {}) {
  object.resize(luminance.size(), 0);
  const std::vector<std::uint8_t> rgb = difference_picture(
      grey(luminance), grey(reference), {static_cast<int>(luminance.size()), 1, std::move(object)});
  EXPECT_EQ(rgb.size(), 3 * luminance.size());
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    colours.push_back({rgb[i], rgb[i + 1], rgb[i + 2]});
  }
  return colours;
}

TEST(DifferencePicture, EachBandOfTheRatioHasItsColour) {
  const std::vector<Colour> colours =
      colours_of({9.0F, 3.0F, 1.8F, 1.2F, 1.0F, 0.8F, 0.6F, 0.3F, 0.1F}, std::vector(9, 1.0F));
  for (std::size_t band = 0; band < colours.size(); ++band) {
    EXPECT_EQ(colours[band], difference_bands[band].colour) << difference_bands[band].label;
  }
}

TEST(DifferencePicture, BlackAgainstBlackIsNoDifference) {
  const std::vector<Colour> colours = colours_of({0, 5, 1, 0}, {0, 5, 0, 1});
  EXPECT_EQ(colours[0], difference_bands[4].colour);
  EXPECT_EQ(colours[1], difference_bands[4].colour);
  EXPECT_EQ(colours[2], difference_bands.front().colour);
  EXPECT_EQ(colours[3], difference_bands.back().colour);
}

TEST(DifferencePicture, ScaleIsNeutralInTheMiddleAndMonotoneToItsEnds) {
  // Lightness falls from the middle outward on both sides, red above and blue below.
  std::vector<float> ratios;
  for (int k = -40; k <= 40; ++k) ratios.push_back(std::pow(1.05F, static_cast<float>(k)));
  const std::vector<Colour> colours = colours_of(ratios, std::vector(81, 1.0F));
  const auto lightness = [&](std::size_t k) {
    const Colour& c = colours[k];
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  EXPECT_EQ(colours[40][0], colours[40][1]);
  EXPECT_EQ(colours[40][1], colours[40][2]);
  for (std::size_t k = 40; k < 80; ++k) EXPECT_LE(lightness(k + 1), lightness(k)) << k;
  for (std::size_t k = 40; k > 0; --k) EXPECT_LE(lightness(k - 1), lightness(k)) << k;
  for (std::size_t k = 43; k <= 80; ++k) EXPECT_GT(colours[k][0], colours[k][2]) << k;
  for (std::size_t k = 0; k <= 37; ++k) EXPECT_GT(colours[k][2], colours[k][0]) << k;
  // Equal ratios up and down have nearly equal lightness: within 35 of 255.
  for (std::size_t k = 0; k < 40; ++k) EXPECT_NEAR(lightness(k), lightness(80 - k), 35.0) << k;
  // The extreme ratios have the extreme bands: 1.05^40 = 7, its inverse 0.14.
  EXPECT_EQ(colours.back(), difference_bands.front().colour);
  EXPECT_EQ(colours.front(), difference_bands.back().colour);
}

TEST(DifferencePicture, SkyIsGreyWhateverItsRatio) {
  const std::vector<Colour> colours = colours_of({1, 9, 1}, {1, 1, 1}, {0, no_object, 0});
  EXPECT_EQ(colours[1], difference_sky);
  EXPECT_EQ(difference_sky[0], difference_sky[2]);
  for (const DifferenceBand& band : difference_bands) EXPECT_NE(band.colour, difference_sky);
}

}  // namespace
}  // namespace earthshine::studies
