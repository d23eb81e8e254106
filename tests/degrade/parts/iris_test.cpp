// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/iris.h"

#include <gtest/gtest.h>

#include <cmath>

#include "degrade/chain.h"
#include "degrade/parts/electronics.h"
#include "degrade/parts/optics.h"
#include "tests/degrade/fields.h"

namespace earthshine::degrade {
namespace {

using test::flat;
using test::painted;

constexpr IrisMode automatic[] = {IrisMode::Peak, IrisMode::Normal, IrisMode::Average};

CctvCamera camera_with(IrisMode iris) {
  CctvCamera camera;
  camera.iris = iris;
  camera.white_lux = 0.02;
  camera.f_number_min = 1.4;
  camera.f_number_max = 1000.0;
  camera.gain_max_db = 12.0;
  return camera;
}

// A bright spot in the middle of a slope: every meter gets brighter and darker parts.
double scene(double x, double y) {
  const double r2 = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5);
  return 0.2 + x + (r2 < 0.04 ? 20.0 : 0.0);
}

Picture scene_picture() { return {80, 60, {painted(80, 60, scene).channels[0].values}}; }

// A uniform scene of luminance L through a lens of f-number N: E = pi tau L / (4 N^2).
TEST(Lens, TransferIsInverseInTheSquareOfTheFNumber) {
  CctvCamera camera;
  camera.transmittance = 0.8;
  EXPECT_NEAR(lens_transfer(camera, 2.8), 0.0801, 1e-4);  // 0.08 lx from 1 cd/m^2 at f/2.8
  EXPECT_DOUBLE_EQ(lens_transfer(camera, 2.0) / lens_transfer(camera, 4.0), 4.0);
}

TEST(Lens, GlareKeepsTheMeanAndVeilsBlackByItsShare) {
  Picture picture = flat(10, 10, 0.0F);
  for (std::size_t i = 0; i < 50; ++i) picture.planes[0][i] = 8.0F;
  const Picture out = add_glare(picture, 0.1);
  EXPECT_NEAR(test::moments(out.planes[0]).mean, 4.0, 1e-6);
  EXPECT_NEAR(out.planes[0][99], 0.1 * 4.0, 1e-6);
  EXPECT_NEAR(out.planes[0][0], 0.9 * 8.0 + 0.1 * 4.0, 1e-6);
}

TEST(Meter, EveryModeIsHomogeneous) {
  const Picture dim = scene_picture();
  for (const IrisMode iris : automatic) {
    const CctvCamera camera = camera_with(iris);
    const double once = metered_luminance(dim, camera);
    const Picture bright = transform(dim, [](double l) { return 8.0 * l; });
    EXPECT_NEAR(metered_luminance(bright, camera), 8.0 * once, 1e-6 * once) << word_of(iris);
  }
}

TEST(Meter, FlatSceneIsMeteredAsItself) {
  for (const IrisMode iris : automatic) {
    EXPECT_NEAR(metered_luminance(flat(13, 7, 3.0F), camera_with(iris)), 3.0, 1e-9);
  }
}

// The power-mean inequality: M_p grows with p, and is constant only for a flat scene.
TEST(Meter, PowerMeanGrowsWithItsPowerUnlessTheSceneIsFlat) {
  const Plane values = scene_picture().planes[0], even(4800, 2.0F);
  double last = 0.0;
  for (const double p : {1.0, 4.0, 64.0}) {
    const double mean = power_mean(values, 80, 60, p, 0.0);
    EXPECT_GT(mean, 1.01 * last);
    last = mean;
    EXPECT_NEAR(power_mean(even, 80, 60, p, 0.7), 2.0, 1e-9);
  }
}

TEST(Meter, PeakClosesTheIrisMost) {
  const Picture picture = scene_picture();
  CctvCamera camera = camera_with(IrisMode::Peak);
  camera.iris_target = 1.0;
  const double peak = expose(camera, metered_luminance(picture, camera)).f_number;
  camera.iris = IrisMode::Normal;
  const double normal = expose(camera, metered_luminance(picture, camera)).f_number;
  camera.iris = IrisMode::Average;
  const double average = expose(camera, metered_luminance(picture, camera)).f_number;
  EXPECT_GT(peak, normal);
  EXPECT_GT(normal, average);
}

TEST(Iris, MeteredValueReachesItsTargetInsideTheRange) {
  const Picture picture = scene_picture();
  for (const IrisMode iris : automatic) {
    const CctvCamera camera = camera_with(iris);
    const Exposure exposure = expose(camera, metered_luminance(picture, camera));
    EXPECT_FALSE(exposure.blown || exposure.underexposed);
    EXPECT_EQ(exposure.gain, 1.0);
    const Picture signal =
        to_signal(through_lens(picture, camera, exposure.f_number), camera.white_lux);
    EXPECT_NEAR(metered_luminance(signal, camera), exposure.target, 1e-5) << word_of(iris);
  }
}

// A scene four times as bright needs twice the f-number, a power of two: bitwise the same picture.
TEST(Iris, BrighterSceneInsideTheRangeGivesTheSamePicture) {
  const base::Image dim = painted(200, 150, scene);
  base::Image bright = dim;
  for (float& value : bright.channels[0].values) value *= 4.0F;
  const CctvCamera camera = camera_with(IrisMode::Normal);
  const Result a = degrade(dim, camera, {}), b = degrade(bright, camera, {});
  EXPECT_EQ(a.signal.channels[0].values, b.signal.channels[0].values);
  EXPECT_EQ(b.report.exposure.f_number, 2.0 * a.report.exposure.f_number);
}

TEST(Iris, TooBrightIsBlownAndTooDarkIsUnderexposedAfterAllGain) {
  const CctvCamera camera = camera_with(IrisMode::Average);
  const double lowest = 0.25 * 0.02 / lens_transfer(camera, 1.4);  // at f/1.4 without gain
  const double most_gain = std::pow(10.0, 12.0 / 20.0);
  const Exposure gained = expose(camera, lowest / 2.0);
  EXPECT_EQ(gained.f_number, 1.4);
  EXPECT_NEAR(gained.gain, 2.0, 1e-9);
  EXPECT_FALSE(gained.underexposed);
  const Exposure dark = expose(camera, lowest / most_gain / 10.0);
  EXPECT_NEAR(dark.gain, most_gain, 1e-9);
  EXPECT_TRUE(dark.underexposed);
  const Exposure bright = expose(camera, 1e9);
  EXPECT_EQ(bright.f_number, 1000.0);
  EXPECT_EQ(bright.gain, 1.0);
  EXPECT_TRUE(bright.blown);
}

TEST(Iris, BelowItsRangeTheSignalFallsLinearlyWithTheScene) {
  const CctvCamera camera = camera_with(IrisMode::Peak);
  const auto signal_of = [&](float luminance) {
    CctvCamera linear = camera;
    linear.gamma = 1.0;
    return degrade(test::grey(8, 6, luminance), linear, {}).signal.channels[0].values[0];
  };
  EXPECT_NEAR(signal_of(1e-4F) / signal_of(1e-5F), 10.0F, 1e-4F);
}

TEST(Iris, DoesNotDependOnResolutionOrSeed) {
  const base::Image coarse = painted(100, 75, scene);
  base::Image fine = test::grey(400, 300, 0.0F);
  for (std::size_t i = 0; i < fine.pixel_count(); ++i) {
    fine.channels[0].values[i] = coarse.channels[0].values[(i / 400 / 4) * 100 + (i % 400) / 4];
  }
  CctvCamera camera = camera_with(IrisMode::Normal);
  camera.noise = NoiseMode::Spec;
  camera.snr_db = 20.0;
  Options other;
  other.seed = 99;
  const Result a = degrade(coarse, camera, {}), b = degrade(fine, camera, {}, other);
  EXPECT_EQ(a.report.exposure.f_number, b.report.exposure.f_number);
  EXPECT_NE(a.pixels, b.pixels);
}

TEST(Iris, FixedStandsWhereItIsToldWithItsGain) {
  CctvCamera camera;
  camera.iris = IrisMode::Fixed;
  camera.f_number = 5.6;
  camera.gain_db = 20.0;
  const Exposure exposure = expose(camera, 123.0);
  EXPECT_EQ(exposure.f_number, 5.6);
  EXPECT_NEAR(exposure.gain, 10.0, 1e-12);
  EXPECT_FALSE(exposure.blown || exposure.underexposed);
}

}  // namespace
}  // namespace earthshine::degrade
