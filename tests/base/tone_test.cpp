// SPDX-License-Identifier: Apache-2.0
#include "base/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

Image grey_image(const std::vector<float>& luminance) {
  Image image = make_rgb_image(static_cast<int>(luminance.size()), 1);
  for (Channel& channel : image.channels) channel.values = luminance;
  return image;
}

// A scene from 1 to 10^4 cd/m^2.
std::vector<float> ramp() {
  std::vector<float> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::pow(10.0F, 4.0F * static_cast<float>(i) / 999.0F);
  }
  return values;
}

TEST(Tone, BlackStaysBlack) {
  const ToneMapped black = tone_map(make_rgb_image(5, 4));
  EXPECT_EQ(black.rgb, std::vector<std::uint8_t>(60, 0));
}

// A flat picture is its own log mean: signal 0.18, below white = 1, where the operator is the
// identity. sRGB of 0.18 is 1.055 * 0.18^(1/2.4) - 0.055 = 0.4614, times 255 = 117.6.
TEST(Tone, FlatPictureIsMiddleGreyAtAnyLuminance) {
  for (const float luminance : {1e-6F, 1.0F, 4.2e4F}) {
    EXPECT_EQ(tone_map(grey_image({luminance, luminance})).rgb, std::vector<std::uint8_t>(6, 118));
  }
}

TEST(Tone, ScalingTheSceneChangesTheExposureAndNotThePicture) {
  const std::vector<float> scene = ramp();
  std::vector<float> brighter = scene;
  for (float& value : brighter) value *= 64.0F;
  const ToneMapped a = tone_map(grey_image(scene)), b = tone_map(grey_image(brighter));
  EXPECT_EQ(a.rgb, b.rgb);
  EXPECT_NEAR(a.report.exposure / b.report.exposure, 64.0, 1e-9);
}

TEST(Tone, PercentileBecomesWhiteAndBrighterIsNeverDarker) {
  const std::vector<float> scene = ramp();
  const ToneMapped mapped = tone_map(grey_image(scene));
  // The 99.5th percentile of 1000 values is number 994 of 0 to 999 (0.995 * 999 = 994.005).
  EXPECT_NEAR(mapped.report.white_cd_per_m2, static_cast<double>(scene[994]), 1e-6 * 1e4);
  EXPECT_EQ(mapped.rgb[3 * 994], 255);
  EXPECT_LT(mapped.rgb[3 * 900], 255);
  for (std::size_t i = 1; i < scene.size(); ++i) {
    ASSERT_GE(mapped.rgb[3 * i], mapped.rgb[3 * (i - 1)]);
  }
}

TEST(Tone, BrightLampKeepsItsHue) {
  Image image = make_rgb_image(1000, 1);
  for (Channel& channel : image.channels) channel.values.assign(1000, 1.0F);
  image.channels[0].values[0] = 4e4F;  // far above white; green is half of red, blue is 0
  image.channels[1].values[0] = 2e4F;
  image.channels[2].values[0] = 0.0F;
  const ToneMapped mapped = tone_map(image);
  EXPECT_EQ(mapped.rgb[0], 255);
  EXPECT_EQ(mapped.rgb[1], 188);  // sRGB of 0.5: 255 * (1.055 * 0.5^(1/2.4) - 0.055) = 187.5
  EXPECT_EQ(mapped.rgb[2], 0);
}

TEST(Tone, AFewAllButBlackPixelsDoNotDecideTheExposure) {
  std::vector<float> scene(1000, 10.0F);
  const double plain = tone_map(grey_image(scene)).report.exposure;
  for (std::size_t i = 0; i < 400; ++i) scene[i] = 1e-30F;
  EXPECT_NEAR(tone_map(grey_image(scene)).report.exposure, plain, 1e-12);
}

TEST(Tone, NegativeIsBlackAndNonFiniteIsRefused) {
  EXPECT_EQ(tone_map(grey_image({-5.0F, 1.0F})).rgb[0], 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string message = test::error_of(Blame::Work, [&] {
    return tone_map(grey_image({1.0F, 1.0F, nan}));
  });
  EXPECT_NE(message.find("(2, 0)"), std::string::npos) << message;
}

TEST(Tone, LuminanceChannelGivesTheSameGreyAsRgb) {
  Image y{1000, 1, {}};
  y.add("Y") = ramp();
  EXPECT_EQ(tone_map(y).rgb, tone_map(grey_image(ramp())).rgb);
}

TEST(Tone, AnotherPicturesExposureMakesEqualLuminanceEqualGrey) {
  const std::vector<float> scene = ramp();
  const ToneMapped first = tone_map(grey_image(scene));
  EXPECT_EQ(tone_map_with(grey_image(scene), first.report).rgb, first.rgb);
  // The upper half alone would get another exposure; with the exposure of the whole it is equal to
  // this half.
  const std::vector<float> half(scene.begin() + 500, scene.end());
  const ToneMapped shared = tone_map_with(grey_image(half), first.report);
  EXPECT_NE(tone_map(grey_image(half)).rgb, shared.rgb);
  EXPECT_TRUE(std::equal(shared.rgb.begin(), shared.rgb.end(), first.rgb.begin() + 3 * 500));
  EXPECT_EQ(shared.report.exposure, first.report.exposure);
}

TEST(Tone, ExposureOfABlackPictureIsPlain) {
  const ToneReport plain = tone_map(make_rgb_image(2, 1)).report;
  EXPECT_EQ(plain.exposure, 1.0);
  // Signal 1 is white: sRGB of 0.5 is 188.
  EXPECT_EQ(tone_map_with(grey_image({0.5F, 1.0F}), plain).rgb[0], 188);
}

TEST(Tone, SameBytesForOneAndTwoThreads) {
  Image image = make_rgb_image(300, 200);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      image.channels[c].values[i] = static_cast<float>((i * 7919 + c * 31) % 5003);
    }
  }
  const ThreadLimit one(1);
  const ToneMapped a = tone_map(image);
  const ThreadLimit two(2);
  EXPECT_EQ(a.rgb, tone_map(image).rgb);
}

// IEC 61966-2-1: 12.92 x up to 0.0031308, then 1.055 x^(1/2.4) - 0.055, times 255, rounded.
TEST(Srgb, EveryByteBeginsWhereTheCurveRoundsToIt) {
  const auto exact = [](double x) {
    const double v = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
  };
  for (int i = 0; i <= 200'000; ++i) {
    const double x = i / 200'000.0;
    ASSERT_EQ(static_cast<int>(srgb_byte(x)), exact(x)) << x;
  }
  for (int byte = 1; byte < 256; ++byte) {
    const double v = (byte - 0.5) / 255.0;
    const double begin = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    EXPECT_EQ(static_cast<int>(srgb_byte(begin * (1.0 + 1e-12))), byte);
    EXPECT_EQ(static_cast<int>(srgb_byte(begin * (1.0 - 1e-12))), byte - 1);
  }
  EXPECT_EQ(srgb_byte(-1.0), 0);
  EXPECT_EQ(srgb_byte(7.0), 255);
}

// At white 1 - 0.4 exp(-(1 - 0.6) / 0.4) = 1 - 0.4 / e = 0.8528, at twice white 1 - 0.4 exp(-3.5) =
// 0.9879; linear below 0.6 of white.
TEST(Tone, ShoulderIsStraightBelowAndNeverClips) {
  const ToneMapped shown =
      expose(grey_image({1.0F, 3.0F, 5.0F, 10.0F, 20.0F}), 10.0, ToneCurve::Shoulder);
  const double wanted[] = {0.1, 0.3, 0.5, 1.0 - 0.4 * std::exp(-1.0), 1.0 - 0.4 * std::exp(-3.5)};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(shown.rgb[3 * i], srgb_byte(wanted[i])) << i;
}

TEST(Tone, ClippedPictureIsLinearUpToWhite) {
  const ToneMapped shown = expose(grey_image({0.0F, 2.5F, 10.0F, 11.0F}), 10.0, ToneCurve::Clip);
  const std::uint8_t wanted[] = {0, srgb_byte(0.25), 255, 255};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(shown.rgb[3 * i], wanted[i]) << i;
}

// Pixels of all pictures together; the black and the faint ones are not lit. The lit ones are
// numbers 0 to 999 of the ramp, and their 90th percentile is number 899 (0.9 * 999 = 899.1).
TEST(Tone, WhiteIsThePercentileOfTheLitPixelsOfAllPictures) {
  const std::vector<float> scene = ramp();
  const Image lit = grey_image(scene), dark = grey_image(std::vector<float>(1000, 0.0F)),
              faint = grey_image(std::vector<float>(1000, 0.05F));  // below 1e-5 of the brightest
  EXPECT_EQ(white_at({&lit, &dark, &faint}, 90.0), static_cast<double>(scene[899]));
  EXPECT_EQ(white_at({&lit, &dark}, 100.0), static_cast<double>(scene[999]));
  EXPECT_EQ(white_at({&dark}, 90.0), 1.0);
}

}  // namespace
}  // namespace earthshine::base
