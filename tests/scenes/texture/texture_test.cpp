// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace earthshine::scenes {
namespace {

// Grey values, opaque unless `alpha` is given.
base::Pixels picture(int width, int height, const std::vector<int>& greys, int alpha = 255) {
  base::Pixels pixels{width, height, {}};
  for (const int grey : greys) {
    for (int c = 0; c < 3; ++c) pixels.rgba.push_back(static_cast<std::uint8_t>(grey));
    pixels.rgba.push_back(static_cast<std::uint8_t>(alpha));
  }
  return pixels;
}

TEST(Texture, ColoursAreDecodedFromSrgbAndDataIsNot) {
  // IEC 61966-2-1: 128/255 encodes 0.2158605; decoding and averaging do not commute.
  EXPECT_NEAR(Texture(picture(1, 1, {128}), {}).at({0.5, 0.5}).g, 0.2158605, 1e-5);
  // Below 0.04045 the encoding is linear: 10/255/12.92.
  EXPECT_NEAR(Texture(picture(1, 1, {10}), {}).at({0.5, 0.5}).g, 0.0030353, 1e-5);
  TextureReading plain;
  plain.is_srgb = false;
  EXPECT_NEAR(Texture(picture(1, 1, {128}), plain).at({0.5, 0.5}).g, 128.0 / 255.0, 1e-5);
  EXPECT_NEAR(Texture(picture(2, 1, {0, 255}), {}).mean().r, 0.5, 1e-5);
}

TEST(Texture, MeanIsThatOfAllTexels) {
  std::vector<int> greys;
  for (int k = 0; k < 15; ++k) greys.push_back((37 * k * k) % 256);
  TextureReading plain;
  plain.is_srgb = false;
  const Texture texture(picture(5, 3, greys), plain);
  double mean = 0.0;
  for (const int grey : greys) mean += grey / 255.0 / 15.0;
  EXPECT_NEAR(texture.mean().r, mean, 1e-9);
}

TEST(Texture, PlacesLieBetweenTexelCentresAndWrapAsAsked) {
  TextureReading reading;
  reading.is_srgb = false;
  const auto at = [&](double u) {
    return Texture(picture(2, 1, {0, 255}), reading).at({u, 0.5}).r;
  };
  EXPECT_NEAR(at(0.25), 0.0, 1e-9);
  EXPECT_NEAR(at(0.75), 1.0, 1e-9);
  EXPECT_NEAR(at(0.5), 0.5, 1e-9);
  EXPECT_NEAR(at(0.0), 0.5, 1e-9);   // half way to the last texel of the previous period
  EXPECT_NEAR(at(7.75), 1.0, 1e-9);  // repeats
  EXPECT_NEAR(at(-0.25), 1.0, 1e-9);
  reading.wrap_u = Wrap::Clamp;
  EXPECT_NEAR(at(-3.0), 0.0, 1e-9);
  EXPECT_NEAR(at(9.0), 1.0, 1e-9);
  reading.wrap_u = Wrap::Mirror;
  EXPECT_NEAR(at(1.25), 1.0, 1e-9);
  EXPECT_NEAR(at(1.75), 0.0, 1e-9);
  reading.is_crisp = true;
  EXPECT_NEAR(at(0.499), 0.0, 1e-9);
  EXPECT_NEAR(at(0.501), 1.0, 1e-9);
}

TEST(Texture, RowsRunDownAndWrapOnTheirOwn) {
  TextureReading reading;
  reading.is_srgb = false;
  reading.wrap_v = Wrap::Clamp;
  const Texture texture(picture(2, 2, {0, 51, 204, 255}), reading);
  EXPECT_NEAR(texture.at({0.25, 0.25}).r, 0.0, 1e-9);
  EXPECT_NEAR(texture.at({0.25, 0.75}).r, 0.8, 1e-9);
  EXPECT_NEAR(texture.at({0.25, 0.375}).r, 0.2, 1e-9);  // a quarter of the distance
  EXPECT_NEAR(texture.at({0.25, -3.0}).r, 0.0, 1e-9);   // would be half of both if repeated
  EXPECT_NEAR(texture.at({0.0, 9.0}).r, 0.9, 1e-9);     // repeated along u
}

TEST(Texture, MasksAreAlphaOrElseGrey) {
  TextureReading mask;
  mask.is_mask = true;
  EXPECT_NEAR(Texture(picture(1, 1, {51}), mask).at({0.5, 0.5}).a, 0.2, 1e-5);
  EXPECT_NEAR(Texture(picture(1, 1, {51}, 102), mask).at({0.5, 0.5}).a, 0.4, 1e-5);
}

TEST(Texture, OtherContentIsAnotherDigest) {
  TextureReading crisp;
  crisp.is_crisp = true;
  const std::uint64_t one = Texture(picture(2, 1, {0, 255}), {}).digest();
  EXPECT_EQ(one, Texture(picture(2, 1, {0, 255}), {}).digest());
  EXPECT_NE(one, Texture(picture(2, 1, {0, 254}), {}).digest());
  EXPECT_NE(one, Texture(picture(1, 2, {0, 255}), {}).digest());
  TextureReading plain, mask, clamped, mirrored;
  plain.is_srgb = false;
  mask.is_mask = true;
  clamped.wrap_u = Wrap::Clamp;
  mirrored.wrap_v = Wrap::Mirror;
  for (const TextureReading& other : {crisp, plain, mask, clamped, mirrored}) {
    EXPECT_NE(one, Texture(picture(2, 1, {0, 255}), other).digest());
  }
}

}  // namespace
}  // namespace earthshine::scenes
