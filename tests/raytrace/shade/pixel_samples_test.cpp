// SPDX-License-Identifier: Apache-2.0
// Numbers of camera samples per pixel, and their gather points.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/render.h"
#include "raytrace/shade/pixel_sums.h"
#include "raytrace/tuning.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// Pixels of 4 samples: columns 0 to 6 of one luminance, 7 to 14 of 1.
PixelSums dim_and_bright(double dim) {
  PixelSums sums(Window{0, 0, 15, 7}, 1, false);
  for (std::size_t p = 0; p < sums.samples.size(); ++p) {
    const double luminance = p % 15 < 7 ? dim : 1.0;
    sums.samples[p] = 4;
    sums.source[p].reflecting = 4.0;
    sums.luminance[p] = 4.0 * luminance;
    sums.luminance2[p] = 4.0 * luminance * luminance;
  }
  return sums;
}

std::vector<std::uint32_t> wanted_by_eye(const PixelSums& sums) {
  const double dimmest = tuning::dimmest_share * sums.mean_luminance();
  return wanted_for_the_eye(sums, scatter_of_samples(sums, dimmest), dimmest);
}

TEST(PixelSamples, TheEyeGetsMoreSamplesWhereDimNeighboursScatter) {
  // Samples of the pixel at (3, 3) have the standard deviation 0.06 and the mean 0.1: more than a
  // third. With a mean of 1 it is less, and 0.005 with a mean of 0.01 is less than a third of a
  // twentieth of the picture's mean, 0.54.
  const auto of_neighbour = [](double luminance, double deviation) {
    PixelSums sums = dim_and_bright(luminance);
    const std::size_t middle = sums.window.index(3, 3);
    sums.luminance2[middle] += 3.0 * deviation * deviation;
    const auto wanted = wanted_by_eye(sums);
    EXPECT_EQ(wanted[middle], 4U);
    EXPECT_EQ(wanted[sums.window.index(1, 3)], 4U);
    return wanted[sums.window.index(2, 4)];
  };
  EXPECT_EQ(of_neighbour(0.1, 0.06), 16U);
  EXPECT_EQ(of_neighbour(1.0, 0.06), 4U);
  EXPECT_EQ(of_neighbour(0.01, 0.005), 4U);
}

TEST(PixelSamples, TheEyeGetsMoreSamplesAtEdgesWhoseSamplesAgree) {
  // n = (0.27 c / 0.02)^(4/3), c the contrast: 32 beside black, 28 -> 32 for 0.9, 13 -> 16 for 0.5.
  for (const auto& [dim, samples] : {std::pair{0.0, 32U}, {0.1, 32U}, {0.5, 16U}, {0.8, 4U}}) {
    const PixelSums sums = dim_and_bright(dim);
    const auto wanted = wanted_by_eye(sums);
    for (int x = 0; x < 15; ++x) {
      EXPECT_EQ(wanted[sums.window.index(x, 3)], x == 6 || x == 7 ? samples : 4U)
          << dim << ' ' << x;
    }
  }
}

TEST(PixelSamples, LightInANarrowGapIsGatheredOncePerPixel) {
  // The floor of a gap 2 cm wide in pixels of 4 mm: the walls are so near that a tenth of a gather
  // ray's mean length is less than the distance from a pixel's centre to its corner.
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.5, 100.0));
  builder.quad(wall, {-0.01, -1, 0}, {0.01, -1, 0}, {0.01, 1, 0}, {-0.01, 1, 0});
  builder.quad(wall, {-0.01, -1, 0}, {-0.01, 1, 0}, {-0.01, 1, 0.5}, {-0.01, -1, 0.5});
  builder.quad(wall, {0.01, -1, 0}, {0.01, -1, 0.5}, {0.01, 1, 0.5}, {0.01, 1, 0});
  const tests::Prepared prepared(builder.scene);
  const radiosity::Solution solution = prepared.solve({});
  scenes::Camera camera;
  camera.position = Vec3(0, 0, 0.5);
  camera.look_at = Vec3(0.0);
  camera.up = Vec3(0, 1, 0);
  camera.fov_deg = 2.0 * std::atan(0.008 / 0.5) * 180.0 / base::pi;
  RenderOptions options;
  options.columns = options.rows = 4;
  options.gather_rays = 32;
  const auto gather_rays = [&](int samples) {
    options.camera_samples = samples;
    return render(prepared, solution, camera, options).report.rays.gather;
  };
  EXPECT_GT(gather_rays(4), 0U);
  EXPECT_EQ(gather_rays(64), gather_rays(4));
}

}  // namespace
}  // namespace earthshine::raytrace
