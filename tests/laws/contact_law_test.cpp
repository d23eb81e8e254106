// SPDX-License-Identifier: Apache-2.0
// Bodies that stand on, lean against or penetrate each other: patches partly under a body count
// with their open part.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/scene_text.h"
#include "tests/support/boxes.h"

namespace earthshine {
namespace {

using radiosity::Solution;
using radiosity::SolveOptions;
using tests::grey;

SolveOptions coarse(double edge_m, int rays = 256) {
  SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = rays;
  return options;
}

// The closed room of 1 m with boxes; M = 1 - rho everywhere.
tests::SceneBuilder furnace(const std::vector<std::array<Vec3, 2>>& boxes) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(grey(0.9, 0.1)),
                      box = builder.material(grey(0.6, 0.4));
  builder.room({wall, wall, wall, wall, wall, wall});
  for (const auto& [low, high] : boxes) tests::add_box(builder, box, low, high);
  return builder;
}

// B = 1 solves B = (1 - rho) + rho B for the open parts, because rays from open points end on open
// points. The form factors close by construction, so that this holds to the solver's tolerance, far
// below the noise of a row, for patches of any size.
void expect_uniform(const tests::SceneBuilder& builder) {
  for (const double edge_m : {1.0, 0.5, 0.19}) {
    const Solution s = tests::Prepared(builder.scene).solve(coarse(edge_m));
    for (const radiosity::ObjectLight& object : s.report.objects) {
      // Without an open part, such as a face pressed on another, no light is reflected: B = M.
      if (object.illuminance_lx.g == 0.0) continue;
      EXPECT_NEAR(object.radiosity_lm_m2.g, 1.0, 1e-7) << object.name << " in cells of " << edge_m;
    }
    EXPECT_NEAR(s.report.objects[5].radiosity_lm_m2.g, 1.0, 1e-7);  // the ceiling
    EXPECT_TRUE(s.report.balance.balanced);
    for (const auto& line : s.report.groups) EXPECT_LE(line.imbalance, 1e-11) << line.name;
  }
}

TEST(Contact, AFurnaceWithABoxOnItsFloorIsUniform) {
  expect_uniform(furnace({{Vec3(0.23, 0.31, 0.0), Vec3(0.64, 0.77, 0.4)}}));
}

TEST(Contact, AFurnaceWithABoxSunkInItsFloorIsUniform) {
  expect_uniform(furnace({{Vec3(0.23, 0.31, -0.07), Vec3(0.64, 0.77, 0.4)}}));
}

TEST(Contact, AFurnaceWithStackedAndCrossingBoxesIsUniform) {
  expect_uniform(furnace({{Vec3(0.2, 0.2, 0.0), Vec3(0.6, 0.7, 0.3)},
                          {Vec3(0.3, 0.1, 0.3), Vec3(0.5, 0.5, 0.6)},
                          {Vec3(0.1, 0.35, 0.1), Vec3(0.9, 0.45, 0.2)},
                          {Vec3(0.33, 0.9, 0.5), Vec3(0.44, 1.0, 0.8)}}));
}

TEST(Contact, AnOpenFloorUnderSunAndLampConservesEnergy) {
  // Without a room, sunk parts see the sky below.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(grey(0.7)), shiny = builder.material(grey(0.3));
  builder.scene.materials[shiny].mirror = Rgb(0.5);
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  tests::add_box(builder, m, {0.2, 0.2, -0.1}, {0.6, 0.7, 0.3});
  tests::add_box(builder, shiny, {0.4, 0.1, 0.1}, {0.8, 0.5, 0.2});
  builder.scene.sun = scenes::Sun();
  builder.scene.sun->direction = glm::normalize(Vec3(1, 2, 3));
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = {0.7, 0.8, 0.5};
  lamp.intensity_cd = Rgb(10.0);
  builder.scene.lamps.push_back(lamp);
  for (const double edge_m : {1.0, 0.19}) {
    const Solution s = tests::Prepared(builder.scene).solve(coarse(edge_m));
    ASSERT_EQ(s.report.groups.size(), 2U);
    EXPECT_TRUE(s.report.balance.balanced);
    for (const auto& line : s.report.groups) EXPECT_LE(line.imbalance, 1e-11) << line.name;
  }
}

Solution solved(const std::string& toml, double edge_m) {
  const scenes::Scene scene = test::SceneFolder().read("format = 1\n" + toml);
  return tests::Prepared(scene).solve(coarse(edge_m));
}

std::string quad(const char* name, const char* corners, const char* material) {
  return std::string("[[object]]\nname = \"") + name +
         "\"\nshape = \"quad\"\ncorners = " + corners + "\nmaterial = \"" + material + "\"\n";
}
constexpr const char* plate =
    "[[material]]\nname = \"wall\"\ndiffuse = 0.9\n[[material]]\nname = \"card\"\ndiffuse = 0.3\n"
    "two_sided = true\n[[object]]\nname = \"plate\"\nshape = \"quad\"\n"
    "corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]\nmaterial = \"wall\"\n";

// Papers that lie flat on a plate and on each other, along the edges of its patches, receive the
// light instead of the plate. The Sun above is within 0.27 degrees of vertical, so that 16 m2
// receive E to a relative 1 - cos 0.27 deg = 1.1e-5. If overlaps counted twice, it would be 24 m2.
TEST(Contact, PapersOnAPlateTakeNoMoreLightThanThePlate) {
  const std::string flat =
      quad("paper", "[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]", "wall") +
      quad("card", "[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]", "card") +
      "[sun]\ndirection = [0, 0, 1]\nilluminance = 100\n";
  const Solution s = solved(plate + flat, 1.0);
  ASSERT_EQ(s.report.groups.size(), 1U);
  EXPECT_NEAR(s.report.groups[0].landed_lm.g, 1600.0, 1.1e-5 * 1600.0);
  EXPECT_LE(s.report.groups[0].imbalance, 1e-11);
}

// Two sides of a panel and a sheet in the plane of both, with lamps above and below at 1 m. Each
// lamp lights 4 m2 with Omega / 4 pi of its flux, Omega = 4 atan(1 / sqrt(3)) = 2 pi / 3 for a
// square of 2 m.
TEST(Contact, APanelOfThreeFacesTakesTheLightOfBothSides) {
  std::string three =
      "[[material]]\nname = \"wall\"\ndiffuse = 0.5\n[[material]]\nname = \"card\"\n"
      "diffuse = 0.3\ntwo_sided = true\n" +
      quad("up", "[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]", "wall") +
      quad("down", "[[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]", "wall") +
      quad("card", "[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]", "card");
  for (const char* z : {"1", "-1"}) {
    three += std::string("[[light]]\nname = \"") + z + "\"\ntype = \"point\"\nposition = [0, 0, " +
             z + "]\nflux = 6\n";
  }
  const Solution s = solved(three, 0.1);
  ASSERT_EQ(s.report.groups.size(), 2U);
  // 400 patches per side with at least 16 points each: direct light is accurate to some
  // thousandths.
  for (const auto& line : s.report.groups) EXPECT_NEAR(line.landed_lm.g, 1.0, 0.01) << line.name;
}

// A box stands on an open plate; a lamp below both lights only the plate's black back.
TEST(Contact, NoLightComesToTheBottomOfABoxOnAPlate) {
  const std::string body =
      "[[object]]\nname = \"box\"\nshape = \"box\"\nmin = [-1, -1, 0]\nmax = [1, 1, 1]\n"
      "material = \"wall\"\n[[light]]\nname = \"lamp\"\ntype = \"point\"\n"
      "position = [0.1, 0, -1]\nflux = 100\n";
  const Solution s = solved(plate + body, 0.5);
  ASSERT_EQ(s.report.objects.size(), 2U);
  for (const auto& object : s.report.objects) EXPECT_EQ(object.illuminance_lx.g, 0.0);
}

}  // namespace
}  // namespace earthshine
