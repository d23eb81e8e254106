// SPDX-License-Identifier: Apache-2.0
#include "studies/targets/target_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/pixels/pixels.h"
#include "scenes/texture/texture.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

constexpr std::int32_t marked = 7;

// A rectangle of the target on empty sky.
ObjectMap rectangle(int columns, int rows, int x0, int y0, int width, int height) {
  ObjectMap map{columns, rows, {}};
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const bool inside = x >= x0 && x < x0 + width && y >= y0 && y < y0 + height;
      map.object.push_back(inside ? marked : no_object);
    }
  }
  return map;
}

TargetView only_target(const scenes::Scene& scene, const scenes::Camera& camera, int size) {
  const auto frame = tests::direct_picture(scene, camera, size);
  const std::vector<TargetView> views = find_targets(scene, camera, object_map(frame.image));
  EXPECT_EQ(views.size(), 1U);
  return views.front();
}

TEST(TargetView, SurroundIsAsLargeAsTheTargetAndOnePixelOff) {
  // 10 x 10 seen. The pixel around it is excluded (12 x 12). Then 4 neighbours add 4 * 12 = 48, and
  // 8 neighbours add 60: from the union of 14 x 12 and 12 x 14 (192) to the union of 16 x 14 and 14
  // x 16 (252). 108 is closer to 100 than 48.
  const ObjectMap map = rectangle(40, 40, 15, 15, 10, 10);
  const TargetView view = find_target(map, marked);
  EXPECT_EQ(view.pixels, 100U);
  EXPECT_EQ(view.surround.size(), 108U);
  for (const std::uint32_t pixel : view.surround) {
    const int x = static_cast<int>(pixel) % 40, y = static_cast<int>(pixel) / 40;
    EXPECT_TRUE(x < 14 || x > 25 || y < 14 || y > 25);
    EXPECT_TRUE(x >= 12 && x <= 27 && y >= 12 && y <= 27);
  }
}

TEST(TargetView, SurroundOfATargetInTheCornerKeepsItsSize) {
  const TargetView view = find_target(rectangle(40, 40, 0, 30, 10, 10), marked);
  EXPECT_GE(view.surround.size(), 75U);
  EXPECT_LE(view.surround.size(), 125U);
}

TEST(TargetView, TargetThatFillsThePictureHasNoSurround) {
  const TargetView view = find_target(rectangle(8, 6, 0, 0, 8, 6), marked);
  EXPECT_EQ(view.pixels, 48U);
  EXPECT_EQ(view.measured.size(), 48U);  // the border of the picture is no outline
  EXPECT_TRUE(view.surround.empty());
}

TEST(TargetView, LuminanceIsTakenInsideTheOutline) {
  EXPECT_EQ(find_target(rectangle(40, 40, 15, 15, 10, 10), marked).measured.size(), 64U);
  // A line has no interior: all of it is measured.
  EXPECT_EQ(find_target(rectangle(40, 40, 15, 5, 1, 30), marked).measured.size(), 30U);
  // 4 x 4 has a core of 4, just a quarter; 3 x 3 has one pixel of 9.
  EXPECT_EQ(find_target(rectangle(40, 40, 15, 15, 4, 4), marked).measured.size(), 4U);
  EXPECT_EQ(find_target(rectangle(40, 40, 15, 15, 3, 3), marked).measured.size(), 9U);
}

TEST(TargetView, TargetThatIsNowhereIsNotInView) {
  const TargetView view = find_target(rectangle(8, 6, 0, 0, 8, 6), 3);
  EXPECT_FALSE(view.in_view());
  EXPECT_TRUE(view.measured.empty() && view.surround.empty());
}

TEST(TargetView, TargetWhollyInViewIsSeenAsIfAlone) {
  // 1 m of the 2 m in view: half of 32 pixels each way. An oblique camera leaves no edge on the
  // grid.
  const auto builder = tests::plate_on_ground(0.4, 0.6);
  const TargetView view = only_target(builder.scene, tests::above(2.0, 2.0), 32);
  EXPECT_EQ(view.pixels, 256U);
  EXPECT_EQ(view.pixels_alone, 256U);
  EXPECT_FALSE(view.cut_by_frame);
  scenes::Camera askew = tests::above(2.0, 2.5);
  askew.position = Vec3(0.7, -0.9, 1.7);
  askew.up = Vec3(0.3, 1, 0.1);
  const TargetView other = only_target(builder.scene, askew, 101);
  EXPECT_GT(other.pixels, 1000U);
  EXPECT_EQ(other.pixels, other.pixels_alone);
}

TEST(TargetView, HalfHiddenPlateIsHalfSeen) {
  // A screen at half the camera's height hides x < 0. Of the plate's 16.5 columns 16 or 17 have
  // their centre on it; the screen's edge, a line of pixels, may be on either side: an error of at
  // most half a column for the edge and half for the rounding, 1 of 16.
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.quad(1, {-3, -3, 1}, {0, -3, 1}, {0, 3, 1}, {-3, 3, 1});
  const TargetView view = only_target(builder.scene, tests::above(2.0, 2.0), 33);
  EXPECT_NEAR(static_cast<double>(view.pixels) / static_cast<double>(view.pixels_alone), 0.5,
              1.0 / 16.0);
  EXPECT_LT(view.pixels, view.pixels_alone);
}

TEST(TargetView, HiddenTargetCountsOnlyAlone) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.plate(1, 3.0, 1.0, true);
  const TargetView view = only_target(builder.scene, tests::above(2.0, 2.0), 32);
  EXPECT_FALSE(view.in_view());
  EXPECT_EQ(view.pixels_alone, 256U);
  EXPECT_EQ(view.hidden.size(), 256U);
  ASSERT_EQ(view.hidden_by.size(), 1U);
  EXPECT_EQ(view.hidden_by.front().object, 2U);
  EXPECT_EQ(view.hidden_by.front().pixels, 256U);
}

TEST(TargetView, WhatHidesMostComesFirst) {
  // Two screens at half the camera's height: a narrow one over x > 0.3, a wide one over x < 0.
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.quad(1, {0.15, -3, 1}, {3, -3, 1}, {3, 3, 1}, {0.15, 3, 1});
  builder.quad(1, {-3, -3, 1}, {0, -3, 1}, {0, 3, 1}, {-3, 3, 1});
  const TargetView view = only_target(builder.scene, tests::above(2.0, 2.0), 64);
  ASSERT_EQ(view.hidden_by.size(), 2U);
  EXPECT_EQ(view.hidden_by[0].object, 3U);
  EXPECT_EQ(view.hidden_by[1].object, 2U);
  EXPECT_EQ(view.hidden_by[0].pixels + view.hidden_by[1].pixels, view.hidden.size());
  EXPECT_EQ(view.pixels + view.hidden.size(), view.pixels_alone);
}

TEST(TargetView, TargetBeyondTheFrameSaysSo) {
  const auto builder = tests::plate_on_ground(0.4, 0.6);
  EXPECT_TRUE(only_target(builder.scene, tests::above(2.0, 0.5), 16).cut_by_frame);
  scenes::Camera away = tests::above(2.0, 1.0);
  away.look_at = Vec3(9, 0, 9);
  const TargetView view = only_target(builder.scene, away, 16);
  EXPECT_EQ(view.pixels_alone, 0U);
  EXPECT_FALSE(view.cut_by_frame);
}

TEST(TargetView, BlackBacksAreCountedWhereASurfaceHasOneSide) {
  const auto seen_back = [](bool up, bool two_sided, double transmit) {
    auto builder = tests::plate_on_ground(0.4, 0.6);
    builder.scene.objects[1].target = false;
    scenes::Material material = tests::grey(0.6);
    material.two_sided = two_sided;
    material.transmit = Rgb(transmit);
    builder.plate(builder.material(material), 1.0, 0.5, up);
    builder.scene.objects[2].target = true;
    const TargetView view = only_target(builder.scene, tests::above(2.5, 2.0), 32);
    EXPECT_GT(view.pixels, 100U);
    return static_cast<double>(view.black_back.size()) / static_cast<double>(view.pixels);
  };
  EXPECT_EQ(seen_back(true, false, 0.0), 0.0);
  EXPECT_EQ(seen_back(false, false, 0.0), 1.0);
  EXPECT_EQ(seen_back(false, true, 0.0), 0.0);
  EXPECT_EQ(seen_back(false, false, 0.1), 0.0);  // glass shows the scene behind it
}

// 2 m across 32 pixels: 0.5 m/s are 8 pixels per second; up is opposite to the rows. Motion along
// the camera's axis leaves the centre in place.
TEST(TargetView, MotionIsThatOfTheMiddleAcrossThePicture) {
  const auto motion = [](const Vec3& velocity) {
    auto builder = tests::plate_on_ground(0.4, 0.6);
    builder.scene.objects[1].motion.velocity_m_s = velocity;
    return only_target(builder.scene, tests::above(2.0, 2.0), 32).motion_px_s;
  };
  EXPECT_NEAR(motion({0.5, 0, 0})[0], 8.0, 1e-9);
  EXPECT_NEAR(motion({0.5, 0, 0})[1], 0.0, 1e-9);
  EXPECT_NEAR(motion({0, 0.5, 0})[1], -8.0, 1e-9);
  EXPECT_NEAR(std::hypot(motion({0, 0, 3})[0], motion({0, 0, 3})[1]), 0.0, 1e-9);
  // A camera that moves the other way shows the same; one that moves along shows a still target.
  const auto from = [](const Vec3& camera_velocity, const Vec3& velocity) {
    auto builder = tests::plate_on_ground(0.4, 0.6);
    builder.scene.objects[1].motion.velocity_m_s = velocity;
    scenes::Camera camera = tests::above(2.0, 2.0);
    camera.motion.velocity_m_s = camera_velocity;
    return only_target(builder.scene, camera, 32).motion_px_s;
  };
  EXPECT_NEAR(from({-0.5, 0, 0}, {0, 0, 0})[0], 8.0, 1e-6);
  EXPECT_NEAR(from({0.5, 0, 0}, {0.5, 0, 0})[0], 0.0, 1e-6);
}

TEST(TargetView, PictureWithoutObjectsIsRefused) {
  EXPECT_THROW((void)object_map(base::make_rgb_image(2, 2)), base::Error);
}

// The plate has a hole over x < 0: one texel opaque, one clear. The ground behind it hides nothing.
TEST(TargetView, HolesShowWhatIsBehindAndHideNothing) {
  tests::SceneBuilder builder = tests::plate_on_ground(0.2, 0.5);
  scenes::Scene& scene = builder.scene;
  scenes::MaterialMaps maps;
  const base::Pixels clear_and_opaque{2, 1, {0, 0, 0, 0, 0, 0, 0, 255}};
  maps.opacity.texture =
      std::make_shared<const scenes::Texture>(clear_and_opaque, scenes::TextureReading());
  maps.opacity.transform = std::make_shared<const scenes::TextureTransform>();
  scene.materials[1].maps = std::make_shared<const scenes::MaterialMaps>(maps);
  for (const Vec3& v : scene.vertices) {
    scene.vertex_uv.emplace_back(static_cast<float>(v.x + 0.5), static_cast<float>(v.y + 0.5));
  }
  const TargetView view = only_target(scene, tests::above(2.0, 2.0), 32);
  EXPECT_EQ(view.pixels, 8U * 16U);
  EXPECT_EQ(view.pixels_alone, view.pixels);
  EXPECT_TRUE(view.hidden_by.empty());
}

// A plate 1 m wide around the origin, of which the picture's 2 m show what lies beyond x = 1.2 of
// the camera's axis: 32 pixels for 2 m, 16 for the plate. The axis is over x = 1.2, so that the
// plate's columns are from (-0.5 - 1.2 + 1) * 16 = -11.2 to 4.8; its rows are 8 to 24.
TEST(TargetView, PixelsOutsideAreThoseOfTheFilmBeyondThePicture) {
  const tests::SceneBuilder builder = tests::plate_on_ground(0.2, 0.5);
  scenes::Camera camera = tests::above(2.0, 2.0);
  camera.position.x = camera.look_at.x = 1.2;
  const PixelsOutside found = pixels_outside(builder.scene, camera, 1, 32, 32);
  EXPECT_EQ(found.count, 11U * 16U);
  EXPECT_EQ((std::array{found.left, found.right, found.top, found.bottom}),
            (std::array{-11, -1, 8, 23}));
  EXPECT_EQ(pixels_outside(builder.scene, tests::above(2.0, 2.0), 1, 32, 32).count, 0U);
  // The film around a wide fisheye picture lies beyond 180 deg: no direction is there twice.
  scenes::Camera wide = tests::above(2.0, 2.0);
  wide.columns = wide.rows = 32;
  wide.intrinsics = {10.0, 10.0, 16.0, 16.0};
  wide.distortion = scenes::Distortion::Fisheye;
  EXPECT_EQ(pixels_outside(builder.scene, wide, 1, 32, 32).count, 0U);
}

}  // namespace
}  // namespace earthshine::studies
