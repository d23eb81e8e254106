// SPDX-License-Identifier: Apache-2.0
// Only effects that cannot matter are skipped. Each bound is tested from both sides: the last case
// in which light cannot arrive, and the first in which it can.
#include <gtest/gtest.h>

#include "tests/scenes/culling_scenes.h"

namespace earthshine::scenes {
namespace {

// A disc of radius r whose centre is h below the horizon is partly above it if h < r. A disc that
// just touches stays on: rounding of the direction must not decide.
TEST(Culling, ADiscOnTheHorizonStaysOnAndOneBelowIsSkipped) {
  for (const double radius : {0.0, 0.2666, 5.0, 60.0, 89.0}) {
    for (const double below : {-1e-3, 0.0, 1e-3}) {
      SCOPED_TRACE(radius);
      SCOPED_TRACE(below);
      Scene scene = floor_of(tests::grey(0.5)).scene;
      scene.sun = sun_at(-radius - below, radius);
      scene.earth = earth_at(-radius - below, radius);
      const Found found = look(scene);
      // Near the nadir sines barely change: 1e-3 deg below 89 deg is 3e-7, within the rounding
      // margin.
      const bool skipped = below > 0.0 && radius < 80.0;
      EXPECT_EQ(found.has("sun"), skipped);
      EXPECT_EQ(found.has("penumbra"), skipped && radius > 0.0);  // a point has none
      EXPECT_EQ(found.has("earth"), skipped);
      EXPECT_EQ(found.effects.sun, !skipped);
      EXPECT_EQ(found.effects.penumbra, !skipped && radius > 0.0);
      EXPECT_EQ(found.effects.earth, !skipped);
    }
  }
}

TEST(Culling, OneSurfaceThatSeesTheDiscKeepsIt) {
  for (const bool turned : {false, true}) {
    tests::SceneBuilder builder = floor_of(tests::grey(0.5));
    builder.plate(0, 1.0, -1.0, !turned);
    builder.scene.sun = sun_at(-30.0, 0.2666);
    builder.scene.earth = earth_at(-80.0, 60.0);
    EXPECT_EQ(look(builder.scene).has("sun"), !turned);
    EXPECT_EQ(look(builder.scene).has("earth"), !turned);
  }
}

TEST(Culling, SheetsAndGlassTakeLightFromBehind) {
  Material sheet = tests::grey(0.5), glass = tests::grey(0.1);
  sheet.two_sided = true;
  glass.transmit = Rgb(0.0, 0.0, 0.5);
  for (const Material& material : {sheet, glass}) {
    Scene scene = floor_of(material).scene;
    scene.sun = sun_at(-45.0, 0.2666);
    scene.earth = earth_at(-80.0, 20.0);
    scene.lamps = {lamp_of(LampKind::Point, {0, 0, -1}, {0, 0, 1})};
    EXPECT_TRUE(look(scene).culled.empty());
  }
}

// Highlights and gloss of an Earth that is never up need no rays, and the table must list them as
// skipped.
TEST(Culling, WhatLivesOnLightThatIsSkippedIsSkippedWithIt) {
  Material shiny = tests::grey(0.5);
  shiny.specular = Rgb(0.2);
  shiny.shininess = 10.0;
  Scene scene = floor_of(shiny).scene;
  scene.earth = earth_at(-80.0, 60.0);
  const Found dark = look(scene);
  for (const char* effect : {"earth", "interreflection", "phong lobe", "glossy reflection"}) {
    EXPECT_TRUE(dark.has(effect)) << effect;
  }
  EXPECT_FALSE(dark.effects.interreflection || dark.effects.solution || dark.effects.phong ||
               dark.effects.glossy || dark.effects.earth || dark.effects.earth_by_gather);

  scene.sun = sun_at(45.0, 0.2666);
  Asked straight;
  straight.paths = LightPaths::Straight;
  EXPECT_TRUE(find_effects(scene, find_light_groups(scene), straight).glossy);
  const Found sunny = look(scene, 0.02, straight);
  EXPECT_TRUE(sunny.effects.phong);
  EXPECT_FALSE(sunny.effects.glossy);
  EXPECT_TRUE(sunny.has("glossy reflection"));
  EXPECT_FALSE(sunny.has("phong lobe"));
}

// r / (1 - r) <= 0.001 e for the wanted error e: r = 0.001 e / (1 + 0.001 e).
TEST(Culling, InterreflectionEndsAtAThousandthOfTheWantedError) {
  for (const double wanted : {0.001, 0.02, 0.5}) {
    const double share = 1e-3 * wanted, limit = share / (1.0 + share);
    for (const double factor : {0.999, 1.001}) {
      tests::SceneBuilder builder = floor_of(tests::grey(0.5 * limit));
      Material lid = tests::grey(0.0);
      lid.diffuse = Rgb(0.0, factor * limit, 0.0);  // the largest of materials and channels
      builder.plate(builder.material(lid), 2.0, 1.0, false);
      builder.scene.lamps = {lamp_of(LampKind::Point, {0, 0, 0.5}, {0, 0, 1})};
      const Found found = look(builder.scene, wanted);
      EXPECT_EQ(found.has("interreflection"), factor < 1.0) << wanted;
      EXPECT_EQ(found.effects.solution, factor > 1.0);
      EXPECT_EQ(found.effects.interreflection, factor > 1.0);
      if (factor < 1.0) {
        EXPECT_NEAR(found.row("interreflection")->error, factor * share, 1e-3 * share);
      }
    }
  }
}

// Two plates face each other if a corner of each is in front of the other.
TEST(Culling, InterreflectionStaysWhereASurfaceHasOneInFrontOfIt) {
  const auto facing = [](bool up, double height, bool sheet) {
    Material material = tests::grey(0.5);
    material.two_sided = sheet;
    tests::SceneBuilder builder = floor_of(material);
    builder.plate(0, 2.0, height, up);
    builder.scene.sun = sun_at(45.0, 0.0);
    return !look(builder.scene).has("interreflection");
  };
  EXPECT_TRUE(facing(false, 1.0, false));
  EXPECT_FALSE(facing(true, 1.0, false));    // looks away
  EXPECT_FALSE(facing(false, -1.0, false));  // back to back
  EXPECT_TRUE(facing(true, 1.0, true));
  EXPECT_TRUE(facing(false, -1.0, true));

  // A wall on the floor: tilted toward it, upright, tilted away.
  for (const double tilt : {-0.1, 0.0, 0.1}) {
    tests::SceneBuilder builder = floor_of(tests::grey(0.5));
    builder.quad(0, {1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {1, 1, 0});
    builder.scene.vertices[4] = {1, -1, 0};
    builder.scene.vertices[5] = {1 + tilt, -1, 1};
    builder.scene.vertices[6] = {1 + tilt, 1, 1};
    builder.scene.vertices[7] = {1, 1, 0};
    builder.scene.sun = sun_at(89.0, 0.0);
    // Its front faces -x: the floor is in front of it for any tilt at the edge x = 1.
    EXPECT_FALSE(look(builder.scene).has("interreflection")) << tilt;
  }
}

TEST(Culling, InterreflectionStaysForThoseThatReadTheSolution) {
  Material lobe = tests::grey(1e-9), mirror = lobe, glass = lobe, panel = tests::grey(1e-9, 5.0);
  lobe.specular = Rgb(0.1);
  mirror.mirror = Rgb(0.1);
  glass.transmit = Rgb(0.1);
  for (const Material& material : {lobe, mirror, glass, panel}) {
    Scene scene = floor_of(material).scene;
    scene.sun = sun_at(45.0, 0.0);
    EXPECT_FALSE(look(scene).has("interreflection"));
  }
  Scene scene = floor_of(tests::grey(1e-9)).scene;
  scene.earth = earth_at(30.0, 60.0);
  EXPECT_FALSE(look(scene).has("interreflection"));
  scene.earth->half_angle_deg = 10.0;  // by shadow rays
  EXPECT_TRUE(look(scene).has("interreflection"));
}

TEST(Culling, HiddenLightsAreSwitchedOff) {
  Scene scene = floor_of(tests::grey(0.5)).scene;
  scene.sun = sun_at(45.0, 0.2666);
  scene.earth = earth_at(45.0, 60.0);
  scene.lamps = {lamp_of(LampKind::Point, {0, 0, 1}, {0, 0, 1}),
                 lamp_of(LampKind::Point, {0, 0, 1}, {0, 0, 1})};
  const Found found = look(scene, 0.02, {}, {true, {true, false}});
  EXPECT_FALSE(found.effects.sun || found.effects.penumbra || found.effects.earth ||
               found.effects.earth_by_gather);
  EXPECT_EQ(found.groups.lamp[0], no_group);
  EXPECT_NE(found.groups.lamp[1], no_group);
  for (const char* effect : {"sun", "earth", "point lamps"}) {
    ASSERT_TRUE(found.has(effect)) << effect;
    EXPECT_NE(found.row(effect)->why.find("wall"), std::string::npos) << effect;
  }
  EXPECT_TRUE(found.has("penumbra"));
}

}  // namespace
}  // namespace earthshine::scenes
