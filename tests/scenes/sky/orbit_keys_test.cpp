// SPDX-License-Identifier: Apache-2.0
// [orbit] and the albedo of [earth] in scene files.
#include <gtest/gtest.h>

#include "scenes/sky/orbit.h"
#include "scenes/sky/sky.h"
#include "tests/scenes/scene_text.h"

namespace earthshine::scenes {
namespace {

using test::holds;

const std::string orbit_text = "format = 1\n[orbit]\naltitude_km = 425\n";

TEST(OrbitKeys, AreKeptInTheScene) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(orbit_text +
                                  "beta_deg = 6\nposition_deg = 40\nattitude = \"inertial\"\n"
                                  "inertial_as = \"tail-down\"\ninertial_at_deg = 90\n"
                                  "inclination_deg = 28.5\nnoon_argument_deg = 20\n");
  ASSERT_TRUE(scene.orbit);
  EXPECT_EQ(scene.orbit->altitude_m, 425e3);
  EXPECT_EQ(scene.orbit->beta_deg, 6.0);
  EXPECT_EQ(scene.orbit->position_deg, 40.0);
  EXPECT_EQ(scene.orbit->attitude, "inertial");
  EXPECT_EQ(scene.orbit->inertial_as, "tail-down");
  EXPECT_EQ(scene.orbit->inertial_at_deg, 90.0);
  EXPECT_EQ(scene.orbit->inclination_deg, 28.5);
  EXPECT_EQ(scene.orbit->noon_argument_deg, 20.0);
  EXPECT_EQ(scene.sun->direction, orbit_state(*scene.orbit, 40.0).sun);
  EXPECT_TRUE(scene.warnings.empty());
  const Scene plain = folder.read(orbit_text);
  EXPECT_EQ(plain.orbit->attitude, "bay-to-earth");
  EXPECT_EQ(plain.orbit->inclination_deg, 0.0);
  EXPECT_FALSE(plain.earth->by_latitude);
  EXPECT_EQ(plain.earth->albedo, Rgb(0.3));
  EXPECT_FALSE(folder.read("format = 1\n").orbit);
}

TEST(OrbitKeys, InertialAtItsOwnPositionIsTheNamedAttitude) {
  const test::SceneFolder folder;
  const Scene kept = folder.read(orbit_text +
                                 "position_deg = 25\nattitude = \"inertial\"\n"
                                 "inertial_at_deg = 25\n");
  Orbit of_the_name;
  of_the_name.attitude = "bay-to-earth";
  const OrbitState named = orbit_state(of_the_name, 25.0);
  EXPECT_LT(glm::length(kept.sun->direction - named.sun), 1e-15);
  EXPECT_LT(glm::length(kept.earth->direction - named.earth), 1e-15);
}

TEST(OrbitKeys, ASunThatStandsTooFarNorthIsAWarning) {
  // Over the pole of an orbit of 28.5 deg the Sun is 61.5 deg from the equator.
  const test::SceneFolder folder;
  const auto warnings = [&](const std::string& keys) {
    return folder.read(orbit_text + keys).warnings;
  };
  ASSERT_EQ(warnings("beta_deg = 90\ninclination_deg = 28.5\n").size(), 1U);
  EXPECT_TRUE(holds(warnings("beta_deg = 90\ninclination_deg = 28.5\n")[0], {"61.5", "23.44"}));
  EXPECT_TRUE(warnings("beta_deg = 90\n").empty());  // an orbit without a defined plane
  EXPECT_TRUE(warnings("beta_deg = 50\ninclination_deg = 28.5\nnoon_argument_deg = 0\n").size());
  EXPECT_TRUE(warnings("beta_deg = 45\ninclination_deg = 28.5\nnoon_argument_deg = -90\n").empty());
}

TEST(OrbitKeys, AlbedoByLatitude) {
  const test::SceneFolder folder;
  const Scene scene = folder.read(orbit_text +
                                  "inclination_deg = 28.5\nposition_deg = 60\n[earth]\n"
                                  "albedo_by = \"latitude\"\nalbedo_a1 = -0.076\n");
  ASSERT_TRUE(scene.earth->by_latitude);
  EXPECT_EQ(scene.earth->by_latitude->a0, 0.34);
  EXPECT_EQ(scene.earth->by_latitude->a1, -0.076);
  EXPECT_EQ(scene.earth->by_latitude->a2, 0.29);
  EXPECT_EQ(scene.earth->albedo, Rgb(1.0));
  EXPECT_EQ(scene.earth->by_latitude->north, orbit_state(*scene.orbit, 60.0).north);
  const Scene plain = folder.read(
      "format = 1\n[sun]\ndirection = [0, 0, 1]\n[earth]\ndirection = [0, 0, -1]\n"
      "altitude_km = 425\nalbedo_by = \"latitude\"\nnorth = [0, 2, 0]\nalbedo = [1, 0.9, 0.8]\n"
      "albedo_a0 = 0.2\nalbedo_a2 = 0\n");
  EXPECT_EQ(plain.earth->by_latitude->north, Vec3(0, 1, 0));
  EXPECT_EQ(plain.earth->by_latitude->a0, 0.2);
  EXPECT_EQ(plain.earth->by_latitude->a2, 0.0);
  EXPECT_EQ(plain.earth->albedo, Rgb(1.0, 0.9, 0.8));
}

TEST(OrbitKeys, WhatDoesNotGoTogetherIsRefused) {
  const test::SceneFolder folder;
  const std::string earth =
      "format = 1\n[sun]\ndirection = [0, 0, 1]\n[earth]\ndirection = [0, 0, -1]\n";
  struct Case {
    std::string toml;
    std::vector<std::string> says;
  };
  const Case cases[] = {
      {orbit_text + "attitude = \"inertia\"\n", {"scene.toml:4:", "attitude", "inertial"}},
      {orbit_text + "inertial_at_deg = 5\n", {"scene.toml:4:", "belongs to attitude \"inertial\""}},
      {orbit_text + "attitude = \"inertial\"\ninertial_as = \"inertial\"\n", {"inertial_as"}},
      {orbit_text + "attitude = \"tail-down\"\nattitude_table = \"a.csv\"\n",
       {"scene.toml:5:", "attitude_table", "one of the two"}},
      {orbit_text + "attitude_table = 5\n", {"scene.toml:4:", "attitude_table"}},
      {orbit_text + "inclination_deg = -1\n", {"inclination_deg", "180"}},
      {orbit_text + "noon_argument_deg = nan\n", {"noon_argument_deg"}},
      {orbit_text + "[earth]\nalbedo_by = \"longitude\"\n", {"albedo_by", "latitude"}},
      {orbit_text + "[earth]\nalbedo_a0 = 0.3\n", {"albedo_a0", "albedo_by = \"latitude\""}},
      {orbit_text + "[earth]\nalbedo_by = \"latitude\"\nnorth = [0, 0, 1]\n",
       {"scene.toml:6:", "north", "cannot be combined with [orbit]"}},
      {orbit_text + "[earth]\nalbedo_by = \"latitude\"\nalbedo_a0 = 1.5\n", {"albedo_a0", "1.5"}},
      {orbit_text + "[earth]\nmodel = \"uniform\"\nradiance = 1\nalbedo_by = \"latitude\"\n",
       {"albedo_by", "belongs to model \"lambert\""}},
      {earth + "altitude_km = 425\nalbedo_by = \"latitude\"\n", {"north", "[x, y, z]"}},
      {earth + "altitude_km = 425\nalbedo_by = \"latitude\"\nnorth = [0, 0, 0]\n", {"north"}},
  };
  for (const Case& wrong : cases) {
    EXPECT_TRUE(holds(folder.refusal(wrong.toml), wrong.says)) << wrong.toml;
  }
}

}  // namespace
}  // namespace earthshine::scenes
