// SPDX-License-Identifier: Apache-2.0
// State of a camera between frames: its iris and the charge of lag.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "degrade/chain.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::grey;

CctvCamera linear() {
  CctvCamera camera;
  camera.gamma = 1.0;
  camera.white_clip = 0.0;
  camera.black_clamp = false;
  return camera;
}

Result next(const base::Image& scene, const CctvCamera& camera, std::uint64_t frame,
            const Memory& before) {
  Options options;
  options.frame = frame;
  return degrade(scene, camera, {}, options, before);
}

// x = ln N^2: x_(j+1) = x_j + g (x* - x_j), so that the error is exactly (1 - g)^j of the first
// one. No overshoot up to g = 1, alternation between 1 and 2, divergence above 2.
TEST(IrisInMotion, ErrorFallsByOneMinusTheRateEachFrame) {
  for (const double rate : {0.2, 0.5, 1.6, 2.2}) {
    CctvCamera camera = linear();
    camera.iris_rate = rate;
    Memory memory = next(grey(40, 30, 10.0F), camera, 0, {}).memory;
    const double start = 2.0 * std::log(*memory.f_number);
    const double goal = start + std::log(50.0);  // the scene is 50 times as bright
    for (std::uint64_t j = 1; j < 5; ++j) {
      const Result result = next(grey(40, 30, 500.0F), camera, j, memory);
      memory = result.memory;
      const double x = 2.0 * std::log(result.report.exposure.f_number);
      EXPECT_NEAR((goal - x) / (goal - start), std::pow(1.0 - rate, static_cast<double>(j)), 1e-5)
          << rate << ' ' << j;
    }
  }
}

// 50 times the light is 5.64 stops: at one stop per frame N grows by sqrt 2 five times.
TEST(IrisInMotion, SlewLimitsTheStopsOfAFrame) {
  CctvCamera camera = linear();
  camera.iris_slew = 1.0;
  Memory memory = next(grey(40, 30, 10.0F), camera, 0, {}).memory;
  const double start = *memory.f_number;
  for (std::uint64_t j = 1; j < 8; ++j) {
    memory = next(grey(40, 30, 500.0F), camera, j, memory).memory;
    const double stops = std::min(static_cast<double>(j), std::log2(50.0));
    EXPECT_NEAR(*memory.f_number / start, std::exp2(stops / 2.0), 1e-6 * *memory.f_number) << j;
  }
}

// While the iris is still closed after a bright scene, the picture is dark: the signal falls by the
// ratio of the light.
TEST(IrisInMotion, SlowIrisLeavesTheSuddenlyDarkSceneDark) {
  CctvCamera camera = linear();
  camera.iris_slew = 0.5;
  const Memory bright = next(grey(40, 30, 1000.0F), camera, 0, {}).memory;
  const Result dark = next(grey(40, 30, 10.0F), camera, 1, bright);
  EXPECT_NEAR(dark.signal.channels[0].values[0], 0.01 * std::exp2(0.5), 1e-5);
  // A moving iris is not underexposed; at rest in the dark it is.
  EXPECT_TRUE(dark.report.exposure.moving);
  EXPECT_FALSE(dark.report.exposure.underexposed);
  camera.f_number_min = 100.0;
  const Result rest = next(grey(40, 30, 1e-9F), camera, 1, {});
  EXPECT_FALSE(rest.report.exposure.moving);
  EXPECT_TRUE(rest.report.exposure.underexposed);
}

TEST(IrisInMotion, AtOnceNeedsNoMemory) {
  const CctvCamera camera = linear();
  const Memory bright = next(grey(40, 30, 1000.0F), camera, 0, {}).memory;
  EXPECT_EQ(next(grey(40, 30, 10.0F), camera, 1, bright).pixels,
            next(grey(40, 30, 10.0F), camera, 1, {}).pixels);
}

// After a light goes out, lag^(2 j) of it remains after j frames of two fields each.
TEST(LagOfASequence, LightThatGoesOutFadesByTwoFieldsAFrame) {
  for (const bool interlace : {false, true}) {
    CctvCamera camera = linear();
    camera.iris = IrisMode::Fixed;
    camera.lag = 0.42;
    camera.interlace = interlace;
    Memory memory = next(grey(40, 30, 1e-6F), camera, 0, {}).memory;
    const double lit = memory.charge.planes[0][0];
    for (std::uint64_t j = 1; j < 5; ++j) {
      memory = next(grey(40, 30, 0.0F), camera, j, memory).memory;
      EXPECT_NEAR(memory.charge.planes[0][0] / lit, std::pow(0.42, 2.0 * static_cast<double>(j)),
                  1e-5)
          << interlace << ' ' << j;
    }
  }
}

// A still scene: every frame has the noise variance v (1 - l) / (1 + l), and the correlation of
// frames is l^2.
TEST(LagOfASequence, StillSceneHasTheSameNoiseInEveryFrame) {
  CctvCamera camera = linear();
  camera.iris = IrisMode::Average;
  camera.iris_target = 0.5;
  camera.lag = 0.5;
  camera.interlace = true;
  camera.noise = NoiseMode::Law;
  camera.noise_b = 1e-3;
  const double count = 400.0 * 300.0;
  const double v = 0.5e-3 / 3.0;
  Memory memory;
  std::vector<float> last;
  for (std::uint64_t j = 0; j < 4; ++j) {
    const Result result = next(grey(400, 300, 10.0F), camera, j, memory);
    memory = result.memory;
    const std::vector<float>& now = result.signal.channels[0].values;
    EXPECT_NEAR(test::moments(now).variance / v, 1.0, 4.0 * std::sqrt(2.0 / count)) << j;
    if (j > 0) {
      EXPECT_NEAR(test::correlation(last, now, 400, 300, 0, 0), 0.25, 4.0 / std::sqrt(count)) << j;
    }
    last = now;
  }
}

TEST(LagOfASequence, PictureOfAnotherShapeIsRefused) {
  CctvCamera camera = linear();
  camera.lag = 0.3;
  const Memory memory = next(grey(40, 30, 1.0F), camera, 0, {}).memory;
  EXPECT_THROW(static_cast<void>(next(grey(30, 30, 1.0F), camera, 1, memory)), base::Error);
}

TEST(Memory, CameraWithoutLagKeepsNoPicture) {
  EXPECT_TRUE(next(grey(40, 30, 1.0F), linear(), 0, {}).memory.charge.planes.empty());
}

}  // namespace
}  // namespace earthshine::degrade
