// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raytrace/paths/path_tracer.h"
#include "studies/picture_error.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

constexpr int across = 16;  // pixels

ReferencePair traced(const scenes::Scene& scene, const scenes::Camera& camera) {
  const tests::Prepared prepared(scene);
  raytrace::PathOptions options;
  options.columns = options.rows = across;
  options.paths_per_pixel = 32;
  ReferencePair pair;
  pair.first = reflected_light(raytrace::trace_paths(prepared, camera, options));
  options.seed = 2;
  pair.second = reflected_light(raytrace::trace_paths(prepared, camera, options));
  return pair;
}

// A plate of 1 m seen from straight above, 2 m of the ground plane in 16 pixels: 8 x 8 of them.
TEST(CountedPixels, SurfacesCountAndSourcesDoNot) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const auto count = [&] {
    const std::vector<bool> counted =
        counted_pixels(traced(builder.scene, tests::above(10.0, 2.0)));
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

// The same plate emits 0.001 pi lm/m^2 and has L = (0.5 1000 + 0.001 pi) / pi: all of its pixels
// count, with 500 / pi without its emission. A disk of 0.2 m, 1.6 pixels, hides its middle. Away
// from the rim the same pixels are in the picture's stated error.
TEST(CountedPixels, AWallThatGlowsCountsByWhatItReflects) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5, 0.001 * base::pi)), 1.0, 0.0, true);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const scenes::Camera camera = tests::above(10.0, 2.0);
  const ReferencePair truth = traced(builder.scene, camera);
  const std::vector<bool> all = counted_pixels(truth);
  EXPECT_EQ(std::count(all.begin(), all.end(), true), 64);
  for (std::size_t p = 0; p < all.size(); ++p) {
    EXPECT_NEAR(truth.first.luminance[p], all[p] ? 500.0 / base::pi : 0.0, 1e-4);
  }

  scenes::Lamp lamp;
  lamp.name = lamp.group = "disk";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0, 0, 0.1);
  lamp.axis = Vec3(0, 0, 1);
  lamp.radius_m = 0.3;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  const std::vector<bool> around = counted_pixels(traced(builder.scene, camera));
  const raytrace::Frame frame = tests::direct_picture(builder.scene, camera, across);
  int hidden = 0;
  for (int y = 0; y < across; ++y) {
    for (int x = 0; x < across; ++x) {
      const double from_middle = std::hypot(x - 7.5, y - 7.5), rim = 0.3 * 8.0 * 10.0 / 9.9;
      if (std::fabs(from_middle - rim) < std::sqrt(0.5)) continue;
      const auto p = static_cast<std::size_t>(across * y + x);
      EXPECT_EQ(frame.error.counts(p), around[p]) << x << ", " << y;
      hidden += from_middle < rim ? 1 : 0;
    }
  }
  EXPECT_GE(hidden, 4);
}

}  // namespace
}  // namespace earthshine::studies
