// SPDX-License-Identifier: Apache-2.0
#include "base/image.h"

#include <gtest/gtest.h>

#include "tests/base/temporary_folder.h"

namespace earthshine::base {
namespace {

TEST(Image, NewChannelsAreZeroAndFoundByTheirName) {
  Image image{3, 2, {}};
  image.add("Z")[5] = 4.0F;
  ASSERT_NE(image.find("Z"), nullptr);
  EXPECT_EQ(image.find("Z")->values, (std::vector<float>{0, 0, 0, 0, 0, 4}));
  EXPECT_EQ(image.find("R"), nullptr);
}

// Rec. 709: the three weights add up to 1, so that white of radiance 1 has luminance 1.
TEST(Image, LuminanceWeighsRec709PrimariesAndSumsToOne) {
  Image image = make_rgb_image(4, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels[c].values[c] = 1.0F;
    image.channels[c].values[3] = 1.0F;
  }
  const std::vector<float> y = luminance_of(image);
  EXPECT_FLOAT_EQ(y[0], 0.2126F);
  EXPECT_FLOAT_EQ(y[1], 0.7152F);
  EXPECT_FLOAT_EQ(y[2], 0.0722F);
  EXPECT_FLOAT_EQ(y[3], 1.0F);
}

TEST(Image, SingleChannelYIsItsOwnLuminance) {
  Image image{2, 1, {}};
  image.add("Y") = {0.5F, 7.0F};
  EXPECT_EQ(luminance_of(image), (std::vector<float>{0.5F, 7.0F}));
}

TEST(Image, WithoutColourOrLuminanceIsRefused) {
  Image image{1, 1, {}};
  image.add("Z");
  EXPECT_NE(test::error_of(Blame::Input, [&] { return luminance_of(image); }).find("neither"),
            std::string::npos);
}

}  // namespace
}  // namespace earthshine::base
