// SPDX-License-Identifier: Apache-2.0
#include "raytrace/blend.h"

#include <gtest/gtest.h>

namespace earthshine::tests {
namespace {

using raytrace::Frame;

// Two pixels; the second of `source` shows a source.
Frame frame(float light, float other, float variance, bool source) {
  Frame made;
  made.image = base::make_rgb_image(2, 1);
  made.window = {0, 0, 2, 1};
  for (const char* name : {"light_a.R", "light_a.G", "light_a.B", "light_b.R", "light_b.G",
                           "light_b.B", "direct.R", "variance", "object"}) {
    made.image.add(name);
  }
  for (base::Channel& channel : made.image.channels) {
    const bool a = channel.name.starts_with("light_a"), b = channel.name.starts_with("light_b");
    const float value = a ? light : b ? other : light + other;
    channel.values = {value, value};
    if (channel.name == "variance") channel.values = {variance, variance};
    if (channel.name == "object") channel.values = {3.0F, 3.0F};
  }
  made.squared_error = {variance, source ? raytrace::shows_source : variance};
  made.report.rays.camera = 10;
  made.report.relative_noise = 0.3;
  made.report.camera_samples = 4.0;
  made.report.gather_rays = 8;
  return made;
}

// Independent noise: the variance of w b + (1 - w) a is w^2 b + (1 - w)^2 a.
TEST(Blend, RadianceIsTheWeightedMeanAndVarianceFollows) {
  const Frame both =
      raytrace::blend(frame(1.0F, 2.0F, 0.5F, false), frame(5.0F, 4.0F, 0.3F, false), 0.25);
  EXPECT_FLOAT_EQ(both.image.find("light_a.R")->values[0], 2.0F);
  EXPECT_FLOAT_EQ(both.image.find("light_b.G")->values[1], 2.5F);
  EXPECT_FLOAT_EQ(both.image.find("direct.R")->values[0], 0.75F * 3.0F + 0.25F * 9.0F);
  EXPECT_FLOAT_EQ(both.image.find("variance")->values[0], 0.5625F * 0.5F + 0.0625F * 0.3F);
  EXPECT_FLOAT_EQ(both.squared_error[1], 0.5625F * 0.5F + 0.0625F * 0.3F);
  EXPECT_NEAR(both.report.relative_noise, std::hypot(0.75 * 0.3, 0.25 * 0.3), 1e-12);
}

TEST(Blend, LightLayersAddUpToThePictureToTheLastBit) {
  const Frame both =
      raytrace::blend(frame(0.1F, 0.7F, 0.0F, false), frame(0.3F, 1e-6F, 0.0F, false), 1.0 / 3.0);
  for (const char* c : {"R", "G", "B"}) {
    const auto value = [&](const std::string& name) { return both.image.find(name)->values[0]; };
    EXPECT_EQ(value(c), value(std::string("light_a.") + c) + value(std::string("light_b.") + c));
  }
}

TEST(Blend, WhatOneRayFillsStaysAndRaysAndSamplesAddUp) {
  const Frame both =
      raytrace::blend(frame(1.0F, 1.0F, 0.1F, false), frame(1.0F, 1.0F, 0.1F, true), 0.5);
  EXPECT_EQ(both.image.find("object")->values[0], 3.0F);
  EXPECT_EQ(both.squared_error[1], raytrace::shows_source);
  EXPECT_EQ(both.report.rays.camera, 20U);
  EXPECT_EQ(both.report.camera_samples, 8.0);
  EXPECT_EQ(both.report.gather_rays, 16);
}

}  // namespace
}  // namespace earthshine::tests
