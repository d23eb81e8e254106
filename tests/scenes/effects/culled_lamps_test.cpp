// SPDX-License-Identifier: Apache-2.0
// Lamps that reach no surface and no camera.
#include <gtest/gtest.h>

#include "base/numbers/random.h"
#include "tests/scenes/culling_scenes.h"

namespace earthshine::scenes {
namespace {

// A lamp of half width w in the plane z = -h, tilted by 45 degrees about y, extends up to -h + w
// sin 45: above 0 it lights the floor's front. The disk's radius bounds its extent.
TEST(Culling, LampsBehindEverySurfaceAreSkipped) {
  const double tilted = 0.25 * std::sqrt(0.5), edge = 1e-3;
  struct Case {
    LampKind kind;
    double depth_m;  // at which it just fails to light the front
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

// Lamps above the floor that emit upward: a flat lamp and a spot of up to 180 degrees do not light
// what is behind their plane; a point lamp has no axis and emits in all directions.
TEST(Culling, FlatLampsAndSpotsShineOnlyForward) {
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

// Random spots and quads: if any point of a quad's front is in the cone, the spot is on.
TEST(Culling, ASpotIsSkippedOnlyIfNoPointOfASurfaceIsInItsCone) {
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
  EXPECT_GT(skipped, 100U);  // some spots are skipped
  EXPECT_LT(skipped, 390U);
}

// The lens extends half its aperture above the camera: one millimetre below and above the plane.
TEST(Culling, AFlatLampIsKeptWhileACameraOrItsLensMaySeeItShine) {
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

TEST(Culling, LampsAreSkippedOneByOneAndKeepTheirGroups) {
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

}  // namespace
}  // namespace earthshine::scenes
