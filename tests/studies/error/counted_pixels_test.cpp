// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "studies/error/picture_error.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

// A plate of 1 m seen from straight above, 2 m of the ground plane in 16 pixels: 8 x 8 of them.
TEST(CountedPixels, SurfacesCountAndSourcesDoNot) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const raytrace::CameraModel camera = raytrace::make_camera_model(tests::above(10.0, 2.0), 16, 16);
  const auto count = [&] {
    const tests::Prepared prepared(builder.scene);
    const std::vector<bool> counted = counted_pixels(prepared, camera).counted;
    return std::count(counted.begin(), counted.end(), true);
  };
  EXPECT_EQ(count(), 64);
  // A disk lamp of 0.2 m above it, shining up, hides its middle.
  scenes::Lamp lamp;
  lamp.name = lamp.group = "disk";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0, 0, 0.1);
  lamp.axis = Vec3(0, 0, 1);
  lamp.radius_m = 0.2;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  EXPECT_LT(count(), 64);
  EXPECT_GT(count(), 32);
  builder.scene.materials[0].diffuse = Rgb(0.0);
  EXPECT_EQ(count(), 0);
}

// The same plate, which emits 0.001 pi lm/m^2 and shows L = (0.5 1000 + 0.001 pi) / pi: all of its
// pixels count, and without what it emits it shows 500 / pi. A disk of 0.2 m, 1.6 pixels, before it
// hides its middle. Away from the rim the pixels are those that the picture states an error of.
TEST(CountedPixels, AWallThatGlowsCountsByWhatItReflects) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5, 0.001 * base::pi)), 1.0, 0.0, true);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const scenes::Camera camera = tests::above(10.0, 2.0);
  const auto counted = [&] {
    const tests::Prepared prepared(builder.scene);
    return counted_pixels(prepared, raytrace::make_camera_model(camera, 16, 16));
  };
  const CountedPixels all = counted();
  EXPECT_EQ(std::count(all.counted.begin(), all.counted.end(), true), 64);
  std::vector<float> shown(16 * 16, 0.0F);
  for (std::size_t p = 0; p < shown.size(); ++p) {
    if (!all.counted[p]) continue;
    EXPECT_NEAR(all.source[p], 0.001, 1e-12);
    shown[p] = static_cast<float>(500.0 / base::pi + 0.001);
  }
  take_source_off(all, shown);
  for (std::size_t p = 0; p < shown.size(); ++p) {
    EXPECT_NEAR(double(shown[p]), all.counted[p] ? 500.0 / base::pi : 0.0, 1e-4);
  }

  scenes::Lamp lamp;
  lamp.name = lamp.group = "disk";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0, 0, 0.1);
  lamp.axis = Vec3(0, 0, 1);
  lamp.radius_m = 0.3;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  const CountedPixels around = counted();
  const raytrace::Frame frame = tests::direct_picture(builder.scene, camera, 16);
  int hidden = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double from_middle = std::hypot(x - 7.5, y - 7.5), rim = 0.3 * 8.0 * 10.0 / 9.9;
      if (std::fabs(from_middle - rim) < std::sqrt(0.5)) continue;
      const auto p = static_cast<std::size_t>(16 * y + x);
      EXPECT_EQ(frame.error.counts[p] != 0, around.counted[p]) << x << ", " << y;
      hidden += from_middle < rim ? 1 : 0;
    }
  }
  EXPECT_GE(hidden, 4);
}

}  // namespace
}  // namespace earthshine::studies
