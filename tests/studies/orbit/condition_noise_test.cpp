// SPDX-License-Identifier: Apache-2.0
// Texts about the noise of conditions, with light and almost without.
#include "studies/orbit/condition_noise.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "scenes/text/message_text.h"

namespace earthshine::studies {
namespace {

const std::array<std::string, 3> names = {"0 deg, on", "60 deg, on", "90 deg, on"};

// 0.2 of 4 cd/m^2 are 5 %; 3 of 0.3 cd/m^2 would be 1000 %, which is meaningless for that light.
TEST(NoiseText, MoreNoiseThanLightHasNoShareOfIt) {
  const ConditionNoise lit = noise_of_condition(0.2, 4.0), dark = noise_of_condition(3.0, 0.3);
  EXPECT_NEAR(lit.relative.value(), 0.05, 1e-15);
  EXPECT_EQ(lit.cd_m2, 0.2);
  EXPECT_FALSE(dark.relative);
  EXPECT_EQ(dark.cd_m2, 3.0);
  EXPECT_EQ(noise_of_condition(0.3, 0.3).relative, 1.0);
  EXPECT_FALSE(noise_of_condition(0.0, 0.0).relative);
}

TEST(NoiseText, FiguresHaveTwoDigitsAndNoPowerOfTen) {
  EXPECT_EQ(scenes::two_digits(0.0), "0");
  EXPECT_EQ(scenes::two_digits(0.00001349), "0.000013");
  EXPECT_EQ(scenes::two_digits(1e-298), "1e-298");  // not three hundred zeros
  EXPECT_EQ(scenes::two_digits(0.71), "0.71");
  EXPECT_EQ(scenes::two_digits(7.06), "7.1");
  EXPECT_EQ(scenes::two_digits(99.6), "100");
  EXPECT_EQ(scenes::two_digits(2041.0), "2000");
  EXPECT_EQ(scenes::percent(1.34), "130 %");
}

TEST(NoiseText, DarkConditionsAreStatedInLuminance) {
  const std::array lit = {noise_of_condition(0.2, 4.0), noise_of_condition(0.9, 10.0),
                          noise_of_condition(3.0, 100.0)};
  EXPECT_EQ(noise_text(lit, names),
            "noise of 3 to 9 % of the mean in the conditions' pictures, most in 60 deg, on");
  std::array some = lit;
  some[2] = noise_of_condition(3.0, 0.3);
  EXPECT_EQ(noise_text(some, names),
            "noise of 5 to 9 % of the mean in the conditions' pictures, most in 60 deg, on; noise "
            "of 3 cd/m², more than its light, in 90 deg, on");
  some[0] = some[1];
  EXPECT_EQ(noise_text(some, names),
            "noise of 9 % of the mean in the conditions' pictures, most in 60 deg, on; noise of 3 "
            "cd/m², more than its light, in 90 deg, on");
  std::array dark = some;
  dark[0] = noise_of_condition(2040.0, 0.001);
  dark[1] = ConditionNoise();
  EXPECT_EQ(noise_text(dark, names),
            "noise of up to 2000 cd/m², more than their light, in 2 dark ones, most in 0 deg, on");
  EXPECT_EQ(noise_text(std::array<ConditionNoise, 3>{}, names), "");
}

}  // namespace
}  // namespace earthshine::studies
