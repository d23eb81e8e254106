// SPDX-License-Identifier: Apache-2.0
// The chain with every stage on: the corner of a picture, and recorded moments for other machines.
#include <gtest/gtest.h>

#include "degrade/chain.h"
#include "degrade/settings/presets.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::linear_camera;
using test::painted;
using test::slope;

// The corner of a scene on the corner of the grid is the corner of the picture, outside the reach
// of the blur. Noise is keyed by position; stages that depend on the whole picture (meter, glare)
// are fixed.
TEST(WholeChain, CornerOfThePictureIsThePictureOfTheCorner) {
  CctvCamera camera = linear_camera();
  camera.blur_h = camera.blur_v = 0.35;
  camera.noise = NoiseMode::Photon;
  camera.lag = 0.3;
  camera.interlace = true;
  camera.bandwidth_mhz = 3.0;
  Monitor whole, corner;
  whole.rows = 80;
  whole.columns = 100;
  corner.rows = 40;
  corner.columns = 100;  // a line of the whole screen has the line's time
  const base::Image in = painted(100, 80, slope);
  base::Image part = test::grey(50, 40, 0.0F);
  for (std::size_t i = 0; i < part.pixel_count(); ++i) {
    part.channels[0].values[i] = in.channels[0].values[i / 50 * 100 + i % 50];
  }
  const Result all = degrade(in, camera, whole), some = degrade(part, camera, corner);
  ASSERT_EQ(some.report.sensor.columns, 50);
  constexpr std::size_t reach = 12;
  for (std::size_t y = 0; y < 40 - reach; ++y) {
    for (std::size_t x = 0; x < 50 - reach; ++x) {
      ASSERT_NEAR(some.signal.channels[0].values[y * 50 + x],
                  all.signal.channels[0].values[y * 100 + x], 2e-6)
          << x << ' ' << y;
    }
  }
}

// Recorded moments of a picture through every stage, which other machines and compilers must
// reproduce. Different rounding of a power or a logarithm changes single values by a relative 1e-7.
TEST(WholeChain, EveryStageTogetherGivesTheRecordedMoments) {
  CctvCamera camera = find_preset("sit-monochrome")->camera;
  camera.fall_off = 4.0;
  camera.glare = 0.02;
  camera.lens_blur = 0.3;
  camera.shading_percent = 20.0;
  camera.lag = 0.42;
  camera.smear_db = 90.0;
  camera.saturation = 0.5;
  camera.bloom = 0.5;
  camera.noise = NoiseMode::Photon;
  camera.dark_electrons = 5.0;
  camera.dsnu_percent = 0.1;
  camera.bandwidth_mhz = 4.2;
  camera.aperture_correction = 0.3;
  camera.bits = 8;
  camera.interlace = true;
  Options options;
  options.fov_deg = 40.0;
  const Result result = degrade(painted(400, 300, slope), camera, {}, options);
  const test::Moments m = test::moments(result.viewed.channels[0].values);
  EXPECT_NEAR(m.mean, 36.82393, 1e-4);
  EXPECT_NEAR(m.variance, 92.1467, 1e-2);
}

}  // namespace
}  // namespace earthshine::degrade
