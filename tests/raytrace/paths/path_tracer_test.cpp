// SPDX-License-Identifier: Apache-2.0
// The reference path tracer against closed forms, without the final gather.
#include "raytrace/paths/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "tests/raytrace/path_picture.h"

namespace earthshine::raytrace {
namespace {

class PathFurnace : public testing::TestWithParam<double> {};

TEST_P(PathFurnace, ClosedRoomHasRadianceMOverPiOneMinusRho) {
  // Every bounce adds M / pi: L = (M / pi) (1 + rho + rho^2 + ...). Paths cut at 100 bounces would
  // lack 37 % at rho = 0.99.
  const double rho = GetParam();
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(rho, 0.3));
  builder.room({m, m, m, m, m, m});
  const Frame frame = picture(builder.scene, inside_room(), pixels(8, 64));
  expect_mean(frame, 0.3 / (base::pi * (1.0 - rho)));
  // Only the roulette is random: weights stay above 1/4, then paths end with probability 1 - rho.
  EXPECT_LT(estimate(frame).std_error / estimate(frame).mean, 0.02);
}
INSTANTIATE_TEST_SUITE_P(Reflectances, PathFurnace, testing::Values(0.1, 0.5, 0.9, 0.99));

class PathEarth : public testing::TestWithParam<double> {};

TEST_P(PathEarth, OpenPlateUnderAUniformDiscHasRhoLSineSquared) {
  // E = pi L sin^2(half angle), radiance rho E / pi; wide (hit by paths) and narrow (shadow rays).
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.earth = uniform_earth(GetParam());
  const double sine = std::sin(base::radians(GetParam()));
  expect_mean(picture(builder.scene, above(2.0), pixels(8, 64)), 500.0 * sine * sine);
}
INSTANTIATE_TEST_SUITE_P(HalfAngles, PathEarth, testing::Values(5.0, 15.0, 30.0, 70.0));

TEST(PathTracer, PlateUnderThePlateSeesTheEarthByTheirFormFactor) {
  // A wide plate of rho = 0.5 under a disc of 30 deg, and a black plate of 0.4 m at 1 m above the
  // visible point, smaller than the disc: E = pi L (sin^2(30 deg) - F), F of a parallel square on
  // the axis, 4/pi x atan(x) with x = 0.2 / sqrt(1 + 0.2^2).
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.plate(black, 0.4, 1.0, false);
  builder.scene.earth = uniform_earth(30.0);
  const double x = 0.2 / std::sqrt(1.04);
  const double hidden = 4.0 / base::pi * x * std::atan(x);
  expect_mean(picture(builder.scene, above(0.9), pixels(8, 256)), 500.0 * (0.25 - hidden));
}

TEST(PathTracer, PointLampOnAPlateIsExact) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.8)), 1.0, 0.0, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0, 0, 2);
  lamp.intensity_cd = Rgb(500.0);
  builder.scene.lamps.push_back(lamp);
  const Frame frame = picture(builder.scene, above(1.5), pixels(2, 16));
  EXPECT_NEAR(estimate(frame).mean / (0.8 * 500.0 / 4.0 / base::pi), 1.0, 3e-6);
}

TEST(PathTracer, RectangleLampOnAPlateIsItsFormFactor) {
  // Side 1 m at 1 m on the axis: E = M F, F = 4/pi x atan(x), x = 0.5 / sqrt(1.25).
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.lamps.push_back(panel(1.0, 1.0));
  const double x = 0.5 / std::sqrt(1.25);
  const double exact = 0.5 * 100.0 / base::pi * 4.0 / base::pi * x * std::atan(x);
  expect_mean(picture(builder.scene, above(0.9), pixels(8, 64)), exact);
}

TEST(PathTracer, SmallAndLargeEmittersGiveTheSameFormFactor) {
  // An emitting square above a plate: by shadow rays if it is a small part of the area, hit by
  // paths if it is a large one; radiance rho M F / pi in both cases.
  const double x = 0.5 / std::sqrt(1.25);
  const double exact = 0.5 * 100.0 / base::pi * 4.0 / base::pi * x * std::atan(x);
  for (const double floor_m : {1.0, 10.0}) {
    tests::SceneBuilder builder;
    builder.plate(builder.material(tests::grey(0.5)), floor_m, 0.0, true);
    builder.plate(builder.material(tests::grey(0.0, 100.0)), 1.0, 1.0, false);
    const Frame frame = picture(builder.scene, above(0.9), pixels(8, 256));
    expect_mean(frame, exact);
    EXPECT_EQ(frame.report.rays.shadow > 0, floor_m > 5.0);
  }
}

TEST(PathTracer, AmbientTermLightsWhatTheCameraSeesOnce) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.scene.ambient_radiance = Rgb(10.0);
  EXPECT_NEAR(estimate(picture(builder.scene, inside_room(), pixels(4, 4))).mean, 5.0, 1e-5);
}

// Two lamps, a mirror and gloss in a room.
scenes::Scene furnished_room() {
  tests::SceneBuilder builder;
  scenes::Material material = tests::grey(0.5);
  material.specular = Rgb(0.5);
  material.shininess = 20.0;
  material.mirror = Rgb(0.1);
  const std::uint32_t m = builder.material(material);
  builder.room({m, m, m, m, m, m});
  for (int k = 0; k < 2; ++k) {
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp" + std::to_string(k);
    lamp.position = Vec3(0.4 + 0.2 * k, 0.5, 0.7);
    lamp.intensity_cd = Rgb(10.0, 5.0 * k, 1.0);
    builder.scene.lamps.push_back(lamp);
  }
  return builder.scene;
}

TEST(PathTracer, SameBytesOnOneAndTwoThreads) {
  const scenes::Scene scene = furnished_room();
  std::vector<Frame> frames;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    frames.push_back(picture(scene, inside_room(), pixels(24, 8)));
  }
  for (std::size_t c = 0; c < frames[0].image.channels.size(); ++c) {
    EXPECT_EQ(frames[0].image.channels[c].values, frames[1].image.channels[c].values);
  }
}

TEST(PathTracer, LayersOfLightGroupsAddUpToThePicture) {
  const scenes::Scene scene = furnished_room();
  PathOptions options = pixels(8, 16);
  const Frame together = picture(scene, inside_room(), options);
  options.per_light = true;
  const Frame apart = picture(scene, inside_room(), options);
  for (const char* channel : {"R", "G", "B"}) {
    for (std::size_t p = 0; p < 64; ++p) {
      const auto value = [&](const Frame& frame, const std::string& name) {
        return double(frame.image.find(name + channel)->values[p]);
      };
      const double sum = value(apart, "light_lamp0.") + value(apart, "light_lamp1.");
      EXPECT_NEAR(sum, value(apart, ""), 1e-6 * sum);
      EXPECT_NEAR(value(together, ""), sum, 1e-5 * sum);
    }
  }
  EXPECT_EQ(together.image.find("variance")->values, apart.image.find("variance")->values);
}

TEST(PathTracer, VarianceIsThatOfThePixelsMean) {
  // 256 pixels with the same view: their spread equals each pixel's stated variance. The ratio has
  // a relative standard error of sqrt(2 / 255), a little more for skewed paths (kurtosis 3.3 of the
  // pixels' means at 64 paths leaves it below 0.1).
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.scene.earth = uniform_earth(40.0);
  const Frame frame = picture(builder.scene, above(2.0), pixels(16, 64));
  const PictureMean e = estimate(frame);
  double spread = 0.0;
  for (const float v : frame.image.find("G")->values) spread += std::pow(double(v) - e.mean, 2);
  EXPECT_NEAR(spread / 255.0 / (e.std_error * e.std_error * 256.0), 1.0, 4.0 * 0.1);
}

TEST(PathTracer, StatesTheErrorOfLightThatIsNotSeenStraightFromASource) {
  // A wall and the edge of a lamp in view. Two pictures of independent paths differ by twice the
  // squared error that each states, over the pixels that count and with their weights. Both exclude
  // the lamp's edges, a hundred times brighter than the wall.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  scenes::Lamp lamp = panel(0.4, 0.0);
  lamp.position = Vec3(0.9, 0.3, 0.6);
  builder.scene.lamps.push_back(lamp);
  PathOptions options = pixels(24, 16);
  const Frame one = picture(builder.scene, inside_room(), options);
  options.seed = 2;
  const Frame two = picture(builder.scene, inside_room(), options);
  const std::vector<float>&a = one.error.luminance, &b = two.error.luminance;
  double mean = 0.0, counting = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    if (!one.error.counts(p) || !two.error.counts(p)) continue;
    mean += 0.5 * (double(a[p]) + double(b[p])), counting += 1.0;
  }
  mean /= counting;
  double squares = 0.0, spread = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    if (!one.error.counts(p) || !two.error.counts(p)) continue;
    const double weight = error_weight(0.5 * (double(a[p]) + double(b[p])), mean);
    const double square = std::pow(weight * (double(a[p]) - double(b[p])) / mean, 2) / 2.0;
    squares += square / counting, spread += square * square / counting;
  }
  const double standard_error = std::sqrt((spread - squares * squares) / counting);
  EXPECT_NEAR(std::pow(one.report.relative_noise, 2), squares, 4.0 * standard_error);
  EXPECT_LT(counting, 24.0 * 24.0);          // edges of the lamp are in view
  EXPECT_LT(4.0 * standard_error, squares);  // so that the law can fail
}

// A million paths take seconds: a stop must not wait for the last path of a pixel. With 512 paths
// each pixel queries twice. After a stop at the sixth query, two of four pixels and half of a third
// are traced, and all their camera rays are counted.
TEST(PathTracer, AStopDoesNotWaitForAPixelOfManyPaths) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const tests::Prepared prepared(builder.scene);
  PathOptions options = pixels(4, 512);
  options.rows = 1;
  int asked = 0;
  options.stop = [&asked] { return ++asked == 6; };
  const Frame frame = trace_paths(prepared, above(2.0), options);
  EXPECT_TRUE(frame.report.stopped);
  EXPECT_EQ(frame.report.finished_share, 0.5);
  EXPECT_EQ(frame.report.rays.camera, 2U * 512U + 256U);
}

TEST(PathTracer, SinglePathOrNoPixelIsRefused) {
  EXPECT_THROW((void)picture(scenes::Scene{}, above(1.0), pixels(1, 1)), base::Error);
  EXPECT_THROW((void)picture(scenes::Scene{}, above(1.0), pixels(0, 4)), base::Error);
}

}  // namespace
}  // namespace earthshine::raytrace
