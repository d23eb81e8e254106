// SPDX-License-Identifier: Apache-2.0
// What is skipped must not be able to matter. Each bound is walked up to from both sides: the last
// case where light just cannot arrive, and the first where it can.
#include "scenes/idle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "scenes/lamp_light.h"
#include "tests/support/scene_builder.h"

namespace earthshine::scenes {
namespace {

struct Found {
  std::vector<Idle> idle;
  LightGroups groups;
  Effects effects;

  [[nodiscard]] const Idle* row(const std::string& effect) const {
    const auto found = std::find_if(idle.begin(), idle.end(),
                                    [&](const Idle& off) { return off.effect == effect; });
    return found == idle.end() ? nullptr : &*found;
  }
  [[nodiscard]] bool has(const std::string& effect) const { return row(effect) != nullptr; }
};

Found look(const Scene& scene, double wanted_error = 0.02, const Asked& asked = {},
           const HiddenLights& hidden = {}) {
  Found found;
  found.groups = find_light_groups(scene);
  found.effects = find_effects(scene, found.groups, asked);
  found.idle = switch_off_idle(scene, asked, wanted_error, hidden, found.groups, found.effects);
  return found;
}

Sun sun_at(double height_deg, double radius_deg) {
  const double h = base::radians(height_deg);
  return {{std::cos(h), 0.0, std::sin(h)}, Rgb(1000.0), radius_deg};
}

Earth earth_at(double height_deg, double half_angle_deg) {
  const double h = base::radians(height_deg);
  Earth earth;
  earth.direction = {0.0, std::cos(h), std::sin(h)};
  earth.half_angle_deg = half_angle_deg;
  earth.model = EarthModel::Uniform;
  earth.radiance = Rgb(100.0);
  return earth;
}

// A plate in z = 0, 2 m wide, that looks up.
tests::SceneBuilder floor_of(const Material& material) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(material), 2.0, 0.0, true);
  return builder;
}

Lamp lamp_of(LampKind kind, const Vec3& position, const Vec3& axis) {
  Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = kind;
  lamp.position = position;
  lamp.axis = axis;
  if (kind == LampKind::Rectangle || kind == LampKind::Disk) {
    lamp.exitance = Rgb(10.0);
  } else {
    lamp.intensity_cd = Rgb(10.0);
  }
  return lamp;
}

// A disc whose centre stands h below the horizon and whose radius is r shows above it if h < r. It
// is left on where it just touches: rounding of the direction must not decide.
TEST(Idle, ADiscOnTheHorizonStaysOnAndOneBelowIsSkipped) {
  for (const double radius : {0.0, 0.2666, 5.0, 60.0, 89.0}) {
    for (const double below : {-1e-3, 0.0, 1e-3}) {
      SCOPED_TRACE(radius);
      SCOPED_TRACE(below);
      Scene scene = floor_of(tests::grey(0.5)).scene;
      scene.sun = sun_at(-radius - below, radius);
      scene.earth = earth_at(-radius - below, radius);
      const Found found = look(scene);
      // Near the nadir sines hardly move: 1e-3 deg below 89 deg is 3e-7, within the rounding kept.
      const bool skipped = below > 0.0 && radius < 80.0;
      EXPECT_EQ(found.has("sun"), skipped);
      EXPECT_EQ(found.has("penumbra"), skipped);
      EXPECT_EQ(found.has("earth"), skipped);
      EXPECT_EQ(found.effects.sun, !skipped);
      EXPECT_EQ(found.effects.penumbra, !skipped && radius > 0.0);
      EXPECT_EQ(found.effects.earth, !skipped);
    }
  }
}

TEST(Idle, OneSurfaceThatSeesTheDiscKeepsIt) {
  for (const bool turned : {false, true}) {
    tests::SceneBuilder builder = floor_of(tests::grey(0.5));
    builder.plate(0, 1.0, -1.0, !turned);
    builder.scene.sun = sun_at(-30.0, 0.2666);
    builder.scene.earth = earth_at(-80.0, 60.0);
    EXPECT_EQ(look(builder.scene).has("sun"), !turned);
    EXPECT_EQ(look(builder.scene).has("earth"), !turned);
  }
}

TEST(Idle, SheetsAndGlassTakeLightFromBehind) {
  Material sheet = tests::grey(0.5), glass = tests::grey(0.1);
  sheet.two_sided = true;
  glass.transmit = Rgb(0.0, 0.0, 0.5);
  for (const Material& material : {sheet, glass}) {
    Scene scene = floor_of(material).scene;
    scene.sun = sun_at(-45.0, 0.2666);
    scene.earth = earth_at(-80.0, 20.0);
    scene.lamps = {lamp_of(LampKind::Point, {0, 0, -1}, {0, 0, 1})};
    EXPECT_TRUE(look(scene).idle.empty());
  }
}

// The highlights and the gloss of an Earth that is never up need no rays either, and the table must
// not say that they run.
TEST(Idle, WhatLivesOnLightThatIsSkippedIsSkippedWithIt) {
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

// A lamp of half width w in the plane z = -h, tilted by 45 degrees about y, reaches up to
// -h + w sin 45: the floor's front sees it from there on. The disk's own radius bounds its reach.
TEST(Idle, LampsBehindEverySurfaceAreSkipped) {
  const double tilted = 0.25 * std::sqrt(0.5), edge = 1e-3;
  struct Case {
    LampKind kind;
    double depth_m;  // at which it just cannot shine on the front
  };
  for (const Case& c : {Case{LampKind::Point, 0.0}, Case{LampKind::Measured, 0.0},
                        Case{LampKind::Rectangle, tilted}, Case{LampKind::Disk, 0.25}}) {
    for (const double below : {-edge, edge}) {
      Scene scene = floor_of(tests::grey(0.5)).scene;
      Lamp lamp = lamp_of(c.kind, {0.2, 0, -c.depth_m - below}, glm::normalize(Vec3(-1, 0, 1)));
      lamp.edge_u = 0.5 * glm::normalize(Vec3(1, 0, 1));
      lamp.edge_v = {0.0, 0.5, 0.0};
      lamp.radius_m = 0.25;
      scene.lamps = {lamp};
      const Found found = look(scene);
      EXPECT_EQ(found.groups.lamp[0] == no_group, below > 0.0) << int(c.kind) << " " << below;
      EXPECT_EQ(found.effects.lamps, below < 0.0);
    }
  }
}

// Shining upward from above the floor: a flat lamp and a spot of up to 180 degrees have no light
// for what is behind their plane; a point lamp has no axis and shines all around.
TEST(Idle, FlatLampsAndSpotsShineOnlyForward) {
  for (const LampKind kind :
       {LampKind::Point, LampKind::Spot, LampKind::Rectangle, LampKind::Disk}) {
    for (const double height : {-1.0, 1.0}) {
      Scene scene = floor_of(tests::grey(0.5)).scene;
      Lamp lamp = lamp_of(kind, {0, 0, 1}, {0, 0, height});
      lamp.beam_deg = lamp.field_deg = 180.0;
      lamp.radius_m = 0.1;
      lamp.edge_u = {0.1, 0, 0};
      lamp.edge_v = {0, 0.1 * height, 0};
      scene.lamps = {lamp};
      EXPECT_EQ(look(scene).has(std::string(effect_of(kind_of(kind)))),
                height > 0.0 && kind != LampKind::Point);
    }
  }
}

// From (0, 0, 1) the floor, 2 m wide, lies within atan(sqrt 2) = 54.7 degrees of straight down; its
// triangles are seen within balls about their centres, (1/3, -1/3, 0) and (-1/3, 1/3, 0), of
// radius sqrt(20)/3: 52 degrees off up to 90 more. A spot that looks along x and is 2 a wide misses
// them for sure only where 90 - a > 64.8 + ... : found by rays, not by that bound, below.
TEST(Idle, ASpotIsSkippedOnlyIfNoPointOfASurfaceIsInItsCone) {
  std::size_t skipped = 0;
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    base::Rng random(base::Key(7, base::Stream::Test, trial));
    tests::SceneBuilder builder;
    const auto point = [&] { return 4.0 * Vec3(random.next(), random.next(), random.next()); };
    const Vec3 a = point(), u = 0.3 * point(), v = 0.3 * point();
    builder.quad(builder.material(tests::grey(0.5)), a, a + u, a + u + v, a + v);
    Lamp lamp = lamp_of(LampKind::Spot, point(), glm::normalize(point() - Vec3(2.0)));
    lamp.beam_deg = 1.0;
    lamp.field_deg = 5.0 + 200.0 * random.next();
    builder.scene.lamps = {lamp};
    const bool off = look(builder.scene).has("spot lamps");
    skipped += off ? 1 : 0;
    const Vec3 normal = glm::normalize(glm::cross(u, v));
    bool lit = false;
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = a + random.next() * u + random.next() * v;
      const Vec3 way = lamp.position - p;
      const double cosine = glm::dot(-glm::normalize(way), lamp.axis);
      lit |= glm::dot(normal, way) > 0.0 && cosine > std::cos(base::radians(lamp.field_deg) / 2);
    }
    EXPECT_FALSE(off && lit) << trial;
  }
  EXPECT_GT(skipped, 100U);  // and it does skip
  EXPECT_LT(skipped, 390U);
}

// Half behind a spot's plane, by the last bit and by a millimetre.
TEST(Idle, AFlatLampIsKeptWhileACameraOrItsLensMaySeeItShine) {
  for (const double aperture : {0.0, 0.2}) {
    for (const double over : {-1e-3, 1e-3}) {
      Scene scene = floor_of(tests::grey(0.5)).scene;
      Lamp lamp = lamp_of(LampKind::Disk, {0, 0, 1}, {0, 0, 1});
      lamp.radius_m = 0.1;
      scene.lamps = {lamp};
      Camera camera;
      camera.name = "A";
      camera.position = {3, 0, 1.0 - aperture / 2 + over};
      camera.aperture_m = aperture;
      camera.focus_m = 1.0;
      scene.cameras = {camera};
      EXPECT_EQ(look(scene).has("disk lamps"), over < 0.0) << aperture << " " << over;
      // Only the cameras of the call count.
      scene.cameras.push_back(camera);
      scene.cameras[1].position.z = 0.5;
      Asked asked;
      asked.cameras = {&scene.cameras[1]};
      EXPECT_TRUE(look(scene, 0.02, asked).has("disk lamps"));
    }
  }
}

TEST(Idle, LampsAreSkippedOneByOneAndKeepTheirGroups) {
  Scene scene = floor_of(tests::grey(0.5)).scene;
  scene.lamps = {lamp_of(LampKind::Point, {0, 0, -1}, {0, 0, 1}),
                 lamp_of(LampKind::Point, {0, 0, 1}, {0, 0, 1})};
  scene.lamps[0].group = "behind";
  const Found found = look(scene);
  EXPECT_TRUE(found.has("point lamps"));
  EXPECT_EQ(found.groups.names, (std::vector<std::string>{"behind", "lamp"}));
  EXPECT_EQ(found.groups.lamp[0], no_group);
  EXPECT_EQ(found.groups.lamp[1], 1U);
  EXPECT_TRUE(found.effects.lamps);
}

// r / (1 - r) <= 0.001 e for the wanted error e: r = 0.001 e / (1 + 0.001 e).
TEST(Idle, InterreflectionEndsAtAThousandthOfTheWantedError) {
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
TEST(Idle, InterreflectionStaysWhereASurfaceHasOneInFrontOfIt) {
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

  // A wall that stands on the floor: tilted toward it, upright, tilted away.
  for (const double tilt : {-0.1, 0.0, 0.1}) {
    tests::SceneBuilder builder = floor_of(tests::grey(0.5));
    builder.quad(0, {1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {1, 1, 0});
    builder.scene.vertices[4] = {1, -1, 0};
    builder.scene.vertices[5] = {1 + tilt, -1, 1};
    builder.scene.vertices[6] = {1 + tilt, 1, 1};
    builder.scene.vertices[7] = {1, 1, 0};
    builder.scene.sun = sun_at(89.0, 0.0);
    // Its front looks along -x: the floor is in front of it wherever it stands at the edge x = 1.
    EXPECT_FALSE(look(builder.scene).has("interreflection")) << tilt;
  }
}

TEST(Idle, InterreflectionStaysForThoseThatReadTheSolution) {
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

TEST(Idle, HiddenLightsAreSwitchedOff) {
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
  for (const char* effect : {"sun", "penumbra", "earth", "point lamps"}) {
    ASSERT_TRUE(found.has(effect)) << effect;
    EXPECT_NE(found.row(effect)->why.find("wall"), std::string::npos) << effect;
  }
}

}  // namespace
}  // namespace earthshine::scenes
