// SPDX-License-Identifier: Apache-2.0
// Extreme pictures: a result or a clear error.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "degrade/chain.h"
#include "degrade/settings/presets.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

constexpr Spread shapes[] = {Spread::None, Spread::Gaussian, Spread::Triangle, Spread::Sinc};

void expect_finite(const Result& result) {
  for (const base::Image* image : {&result.viewed, &result.signal}) {
    for (const base::Channel& channel : image->channels) {
      for (float value : channel.values) ASSERT_TRUE(std::isfinite(value));
    }
  }
  EXPECT_TRUE(std::isfinite(result.report.exposure.f_number));
  EXPECT_TRUE(std::isfinite(result.report.exposure.gain));
  EXPECT_TRUE(std::isfinite(result.report.clipped_negative_light));
}

std::string message_of(const base::Image& image, const Options& options = {}) {
  try {
    static_cast<void>(degrade(image, CctvCamera{}, {}, options));
  } catch (const base::Error& e) {
    EXPECT_EQ(e.blame(), base::Blame::Input);
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(ChainRobustness, EveryPresetAndSpreadShowsEveryOddPicture) {
  base::Image range = test::grey(5, 3, 0.0F);
  range.channels[0].values = {0.0F,   1e-45F, 1e-38F, 1e-20F, 1e-6F, 1.0F,    1e3F, 1e6F,
                              1.6e9F, 1e12F,  1e20F,  1e30F,  3e38F, 3.4e38F, 0.0F};
  const base::Image pictures[] = {test::grey(1, 1, 0.0F),
                                  test::grey(1, 1, 5.0F),
                                  test::grey(1, 900, 1.0F),
                                  test::grey(900, 1, 3.4e38F),
                                  test::grey(2, 3, 0.0F),
                                  test::grey(2, 3, 1e-45F),
                                  range};
  for (const Preset& preset : presets()) {
    for (const Spread spread : shapes) {
      Monitor monitor;
      monitor.rows = 60;
      monitor.columns = 80;
      monitor.spread = spread;
      for (const base::Image& picture : pictures) {
        SCOPED_TRACE(std::string(preset.name) + " " + std::string(word_of(spread)));
        expect_finite(degrade(picture, preset.camera, monitor));
      }
    }
  }
}

TEST(ChainRobustness, BlackSceneIsUnderexposedAndBlack) {
  const Result result =
      degrade(test::grey(40, 30, 0.0F), find_preset("sit-monochrome")->camera, {});
  EXPECT_TRUE(result.report.exposure.underexposed);
  EXPECT_EQ(result.report.exposure.f_number, 1.4);
  EXPECT_EQ(result.report.levels.saturated_share, 0.0);
  EXPECT_GT(result.report.levels.crushed_share, 0.5);
}

TEST(ChainRobustness, SunInTheLensIsBlownAndWhite) {
  const Result result =
      degrade(test::grey(40, 30, 1.6e9F), find_preset("sit-monochrome")->camera, {});
  EXPECT_TRUE(result.report.exposure.blown);
  EXPECT_EQ(result.report.levels.saturated_share, 1.0);
  EXPECT_EQ(result.pixels[450], 255);
}

TEST(ChainRobustness, NegativeRadianceIsBlackAndCounted) {
  base::Image picture = test::grey(40, 30, 1.0F);
  picture.channels[0].values[7] = -5.0F;
  picture.channels[0].values[8] = -1e-9F;
  const Result result = degrade(picture, CctvCamera{}, {});
  EXPECT_EQ(result.report.negative_pixels, 2U);
  expect_finite(result);
}

TEST(ChainRobustness, NanAndInfinityAreRefusedWithTheirPlace) {
  base::Image picture = test::grey(40, 30, 1.0F);
  picture.channels[0].values[85] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(message_of(picture).find("pixel (5, 2)"), std::string::npos);
  picture.channels[0].values[85] = std::numeric_limits<float>::infinity();
  EXPECT_NE(message_of(picture).find("pixel (5, 2)"), std::string::npos);
}

TEST(ChainRobustness, PictureWithoutColourOrPixelsIsRefused) {
  base::Image depth{2, 2, {}};
  depth.add("Z");
  EXPECT_NE(message_of(depth).find("neither"), std::string::npos);
  EXPECT_NE(message_of(base::Image{}).find("no pixels"), std::string::npos);
}

TEST(ChainRobustness, UnknownStageIsRefusedWithTheNearest) {
  Options options;
  options.off = {"read-nois"};
  EXPECT_NE(message_of(test::grey(2, 2, 1.0F), options).find("\"read-noise\""), std::string::npos);
}

TEST(ChainRobustness, ColourCameraTakesALuminancePictureAsGrey) {
  Options twin;
  twin.off = {"signal-noise", "read-noise"};
  const Result result =
      degrade(test::grey(4, 3, 1.0F), find_preset("ccd-colour")->camera, {}, twin);
  EXPECT_EQ(result.channels, 3);
  EXPECT_EQ(result.pixels[0], result.pixels[1]);
  EXPECT_EQ(result.pixels[0], result.pixels[2]);
}

}  // namespace
}  // namespace earthshine::degrade
