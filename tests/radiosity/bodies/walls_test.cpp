// SPDX-License-Identifier: Apache-2.0
// A light counts as hidden only if none of its light can reach a camera.
#include "radiosity/bodies/walls.h"

#include <gtest/gtest.h>

#include "base/numbers/random.h"
#include "tests/support/boxes.h"

namespace earthshine::radiosity {
namespace {

using scenes::LampKind;

scenes::Camera camera_at(const Vec3& position, double aperture_m = 0.0) {
  scenes::Camera camera;
  camera.position = position;
  camera.aperture_m = aperture_m;
  camera.focus_m = 1.0;
  return camera;
}

scenes::Lamp lamp_at(const Vec3& position, LampKind kind = LampKind::Point) {
  scenes::Lamp lamp;
  lamp.kind = kind;
  lamp.position = position;
  lamp.intensity_cd = lamp.exitance = Rgb(1.0);
  return lamp;
}

// The room [0,1]^3, seen from inside; `what` may change the material of its faces.
tests::SceneBuilder room(const scenes::Material& wall, const scenes::Material& lid) {
  tests::SceneBuilder builder;
  const std::uint32_t w = builder.material(wall), l = builder.material(lid);
  builder.room({w, w, w, w, w, l});
  return builder;
}
tests::SceneBuilder room() { return room(tests::grey(0.5), tests::grey(0.5)); }

bool lamp_is_hidden(tests::SceneBuilder& builder, const scenes::Lamp& lamp,
                    const scenes::Camera& camera) {
  builder.scene.lamps = {lamp};
  builder.scene.cameras = {camera};
  return hidden_lights(builder.scene, {}).lamps[0];
}

const Vec3 inside(0.5, 0.5, 0.4), outside(3.0, 0.5, 0.5);

TEST(Walls, ALampInAClosedBoxIsHiddenFromOutsideAndTheOtherWayRound) {
  tests::SceneBuilder builder = room();
  EXPECT_TRUE(lamp_is_hidden(builder, lamp_at(inside), camera_at(outside)));
  EXPECT_TRUE(lamp_is_hidden(builder, lamp_at(outside), camera_at(inside)));
  EXPECT_FALSE(lamp_is_hidden(builder, lamp_at(inside), camera_at({0.1, 0.1, 0.1})));
  EXPECT_FALSE(lamp_is_hidden(builder, lamp_at({0.5, 0.5, -2}), camera_at(outside)));
  // Faces outward: their black backs absorb all of its light.
  tests::SceneBuilder box;
  tests::add_box(box, box.material(tests::grey(0.5)), Vec3(0.0), Vec3(1.0));
  EXPECT_TRUE(lamp_is_hidden(box, lamp_at(inside), camera_at(outside)));
}

// A closed object is tested if a lamp or a camera is inside it.
TEST(Walls, AnObjectThatClosesByItselfHidesWhatIsInIt) {
  tests::SceneBuilder box;
  tests::add_box(box, box.material(tests::grey(0.5)), Vec3(0.0), Vec3(1.0));
  for (scenes::Triangle& triangle : box.scene.triangles) triangle.object = 0;
  box.scene.objects.resize(1);
  box.scene.objects[0].triangle_count = static_cast<std::uint32_t>(box.scene.triangles.size());
  box.scene.objects[0].surface.parts = box.scene.objects[0].surface.closed_parts = 1;
  EXPECT_TRUE(lamp_is_hidden(box, lamp_at(inside), camera_at(outside)));
  EXPECT_TRUE(lamp_is_hidden(box, lamp_at(outside), camera_at(inside)));
  EXPECT_FALSE(lamp_is_hidden(box, lamp_at({0.5, 0.5, -2}), camera_at(outside)));
}

TEST(Walls, TheSkyIsHiddenFromACameraInAClosedRoomAlone) {
  tests::SceneBuilder builder = room();
  builder.scene.cameras = {camera_at(inside)};
  EXPECT_TRUE(hidden_lights(builder.scene, {}).sky);
  builder.scene.cameras.push_back(camera_at(outside));
  EXPECT_FALSE(hidden_lights(builder.scene, {}).sky);
  EXPECT_TRUE(hidden_lights(builder.scene, {&builder.scene.cameras[0]}).sky);
  builder.scene.cameras.clear();
  EXPECT_FALSE(hidden_lights(builder.scene, {}).sky);  // `solve` has no cameras
}

// The smallest holes: the lid is a millimetre short, or a nanometre; or one of its corners differs
// in a single bit.
TEST(Walls, AHoleKeepsTheLampOn) {
  for (const double gap : {0.1, 1e-3, 1e-9, 1.2e-16}) {
    tests::SceneBuilder builder = room();
    for (std::size_t k = 20; k < 24; ++k) {  // the corners at z = 1
      Vec3& corner = builder.scene.vertices[k];
      if (corner.x == 1.0) corner.x = 1.0 - gap;
    }
    EXPECT_FALSE(lamp_is_hidden(builder, lamp_at(inside), camera_at(outside))) << gap;
    builder.scene.cameras = {camera_at(inside)};
    EXPECT_FALSE(hidden_lights(builder.scene, {}).sky) << gap;
  }
  // Each of its triangles in turn.
  for (std::size_t t = 0; t < 12; ++t) {
    tests::SceneBuilder builder = room();
    builder.scene.triangles.erase(builder.scene.triangles.begin() + std::ptrdiff_t(t));
    EXPECT_FALSE(lamp_is_hidden(builder, lamp_at(inside), camera_at(outside))) << t;
  }
}

TEST(Walls, GlassMirrorsAndSheetsKeepTheLampOn) {
  scenes::Material glass = tests::grey(0.1), mirror = glass, sheet = glass;
  glass.transmit = Rgb(0.0, 1e-3, 0.0);
  mirror.mirror = Rgb(1e-3, 0.0, 0.0);
  sheet.two_sided = true;
  for (const scenes::Material& lid : {glass, mirror, sheet}) {
    tests::SceneBuilder builder = room(tests::grey(0.5), lid);
    EXPECT_FALSE(lamp_is_hidden(builder, lamp_at(inside), camera_at(outside)));
  }
}

// A lamp of half width w whose middle is w under the lid extends through it, and so does a wide
// lens.
TEST(Walls, TheWholeLampAndTheWholeLensMustBeOnTheirSide) {
  for (const double clear : {-1e-3, 1e-3}) {
    tests::SceneBuilder builder = room();
    scenes::Lamp disk = lamp_at({0.5, 0.5, 0.9 - clear}, LampKind::Disk);
    disk.radius_m = 0.1;
    EXPECT_EQ(lamp_is_hidden(builder, disk, camera_at(outside)), clear > 0.0);
    scenes::Lamp flat = lamp_at({0.5, 0.5, 0.9 - clear}, LampKind::Rectangle);
    flat.edge_u = {0.12, 0, 0};
    flat.edge_v = {0, 0, 0.16};  // half a diagonal: 0.1
    EXPECT_EQ(lamp_is_hidden(builder, flat, camera_at(outside)), clear > 0.0);
    EXPECT_EQ(lamp_is_hidden(builder, lamp_at(outside), camera_at({0.5, 0.5, 0.9 - clear}, 0.2)),
              clear > 0.0);
  }
  // On the wall itself, and within the error of single precision.
  tests::SceneBuilder builder = room();
  for (const double off : {0.0, 1e-9, 1e-6}) {
    EXPECT_FALSE(lamp_is_hidden(builder, lamp_at({0.5, 0.5, 1.0 - off}), camera_at(outside)));
    EXPECT_FALSE(lamp_is_hidden(builder, lamp_at({1.0 - off, 1.0 - off, 0.5}), camera_at(outside)));
  }
}

TEST(Walls, EveryCameraOfTheCallMustBeKeptOff) {
  tests::SceneBuilder builder = room();
  builder.scene.lamps = {lamp_at(inside), lamp_at(outside)};
  builder.scene.cameras = {camera_at(outside), camera_at({0.2, 0.2, 0.2})};
  const auto of = [&](std::vector<const scenes::Camera*> cameras) {
    return hidden_lights(builder.scene, std::move(cameras)).lamps;
  };
  EXPECT_EQ(of({}), (std::vector<bool>{false, false}));
  EXPECT_EQ(of({&builder.scene.cameras[0]}), (std::vector<bool>{true, false}));
  EXPECT_EQ(of({&builder.scene.cameras[1]}), (std::vector<bool>{false, true}));
}

// Random boxes in a room, some without one of their triangles, far from the origin: if a polyline
// of unobstructed segments leads from the lamp to the camera, the lamp is on.
TEST(Walls, NoLampIsHiddenThatAFreeWayLeadsFrom) {
  std::size_t hidden = 0, reached = 0;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    base::Rng random(base::Key(11, base::Stream::Test, trial));
    const Vec3 away(1e4, -2e4, 3e3);
    const auto point = [&] { return Vec3(random.next(), random.next(), random.next()); };
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    for (int box = 0; box < 3; ++box) {
      const Vec3 low = away + point(), size = 0.5 + point();
      tests::add_box(builder, m, low, low + size);
    }
    if (trial % 2 == 0) {
      builder.scene.triangles.erase(builder.scene.triangles.begin() +
                                    std::ptrdiff_t(random.next() * 36));
    }
    const Vec3 from = away + 2.0 * point(), to = away + 2.0 * point();
    const bool off = lamp_is_hidden(builder, lamp_at(from), camera_at(to));
    hidden += off ? 1 : 0;
    const scenes::RayQuery query(builder.scene);
    const auto free = [&](const Vec3& a, const Vec3& b) {
      const double length = glm::length(b - a);
      const scenes::Hit hit = query.closest(a, (b - a) / length);
      return hit.missed() || hit.t >= length;
    };
    bool found = free(from, to);
    for (int way = 0; way < 2000 && !found; ++way) {
      const Vec3 a = away + 4.0 * point() - 1.0, b = away + 4.0 * point() - 1.0;
      found = free(from, a) && free(a, b) && free(b, to);
    }
    reached += found ? 1 : 0;
    EXPECT_FALSE(off && found) << trial;
  }
  EXPECT_GT(hidden, 5U);
  EXPECT_GT(reached, 20U);
}

}  // namespace
}  // namespace earthshine::radiosity
