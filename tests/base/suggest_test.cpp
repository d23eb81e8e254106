// SPDX-License-Identifier: Apache-2.0
#include "base/suggest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace earthshine::base {
namespace {

using Words = std::vector<std::string>;

TEST(Suggest, EditDistanceCountsEditsAndExchangesOfNeighbours) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("gain", ""), 4U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // two substitutions, one insertion
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3U);
  EXPECT_EQ(edit_distance("gian", "gain"), 1U);  // one exchange
  EXPECT_EQ(edit_distance("Gain", "gAIN"), 0U);
}

TEST(Suggest, SmallDistancesOnly) {
  const Words keys = {"gain_max", "gamma", "glare"};
  EXPECT_EQ(nearest_word("gama", keys), "gamma");
  EXPECT_EQ(nearest_word("sparkle", keys), "");
  EXPECT_EQ(nearest_word("b", Words{"A", "B"}), "B");
  EXPECT_EQ(nearest_word("Z", Words{"A", "B"}), "");
  // bay -> tail takes three edits, more than the two of a slip in eight letters.
  EXPECT_EQ(nearest_word("bay-down", Words{"tail-down", "nose-up"}), "");
}

TEST(Suggest, WordsOfOneMeaning) {
  const Words light = {"name", "type", "color", "flux_lm", "intensity_cd"};
  EXPECT_EQ(nearest_word("power", light), "flux_lm");
  EXPECT_EQ(nearest_word("flux", light), "flux_lm");  // the key without its unit
  EXPECT_EQ(nearest_word("spp", Words{"patch_edge", "gather_rays"}), "gather_rays");
  EXPECT_EQ(nearest_word("spp", Words{"gather_rays", "camera_samples"}), "camera_samples");
  EXPECT_EQ(nearest_word("rays", Words{"camera_samples", "gather_rays"}), "gather_rays");
  EXPECT_EQ(nearest_word("--samples", Words{"--set", "--error", "--size"}), "--error");
  EXPECT_EQ(nearest_word("pivot", Words{"part", "name", "position"}), "position");
  EXPECT_EQ(nearest_word("pivot", Words{"part", "name"}), "");
}

// The meaning of a known word comes before its spelling: gain and wait, fov and aov, file and size,
// resolution and solution differ by two letters.
TEST(Suggest, AKnownWordIsNoSlip) {
  EXPECT_EQ(nearest_word("--gain", Words{"--wait", "--exposure"}), "--exposure");
  EXPECT_EQ(nearest_word("--fov", Words{"--aov"}), "");
  EXPECT_EQ(nearest_word("--file", Words{"--size", "--output"}), "--output");
  EXPECT_EQ(nearest_word("--resolution", Words{"--solution", "--size"}), "--size");
  EXPECT_EQ(nearest_word("origin", Words{"position", "pixel_origin"}), "position");
  EXPECT_EQ(nearest_word("bay-to-sky", Words{"bay-to-sun", "bay-to-space"}), "bay-to-space");
  EXPECT_EQ(nearest_word("positon", Words{"rotate", "translate"}), "translate");
  EXPECT_EQ(nearest_word("lamp", Words{"name", "light"}), "light");
  EXPECT_EQ(nearest_word("--earth", Words{"--part"}), "");  // two edits in five letters
}

}  // namespace
}  // namespace earthshine::base
