// SPDX-License-Identifier: Apache-2.0
#include "studies/compare/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

scenes::Lamp panel(double height_m, double edge_m) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "panel";
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = Vec3(0, 0, height_m);
  lamp.edge_u = Vec3(0, edge_m, 0);
  lamp.edge_v = Vec3(edge_m, 0, 0);
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(1000.0);
  return lamp;
}

Comparison compared(const scenes::Scene& scene, const scenes::Camera& camera,
                    std::vector<int> lights, int gather_rays = 64) {
  const tests::Prepared prepared(scene);
  CompareOptions options;
  options.columns = options.rows = 16;
  options.gather_rays = gather_rays;
  options.distributed_lights = std::move(lights);
  return compare(prepared, camera, options);
}

// A room with a floor in the shadow of a table, which only reflected light reaches.
tests::SceneBuilder room_with_table() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.7));
  builder.room({m, m, m, m, m, m});
  scenes::Material sheet = tests::grey(0.7);
  sheet.two_sided = true;
  const std::uint32_t table = builder.material(sheet);
  builder.quad(table, {0.3, 0.3, 0.3}, {0.7, 0.3, 0.3}, {0.7, 0.7, 0.3}, {0.3, 0.7, 0.3});
  builder.quad(m, {0.45, 0.45, 0.01}, {0.55, 0.45, 0.01}, {0.55, 0.55, 0.01}, {0.45, 0.55, 0.01});
  builder.scene.objects[7].name = "under the table";
  builder.scene.objects[7].target = true;
  scenes::Lamp lamp = panel(0.99, 0.2);
  lamp.position = Vec3(0.5, 0.5, 0.99);
  builder.scene.lamps.push_back(lamp);
  return builder;
}
scenes::Camera in_the_room() {
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.1, 0.25);
  camera.look_at = Vec3(0.5, 0.5, 0.01);
  camera.fov_deg = 40.0;
  return camera;
}

TEST(Compare, ReferenceDiffersFromItselfByNothing) {
  const auto builder = room_with_table();
  const Comparison comparison = compared(builder.scene, in_the_room(), {4, 16, 4});
  ASSERT_EQ(comparison.methods.size(), 5U);
  const char* names[] = {"reference", "radiosity", "distributed-4", "distributed-16", "direct"};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(comparison.methods[k].method.name, names[k]);
  const MethodResult& reference = comparison.reference();
  EXPECT_EQ(reference.error.error, 0.0);
  EXPECT_EQ(reference.error.bias, 0.0);
  EXPECT_EQ(reference.off_share, 0.0);
  EXPECT_EQ(reference.error.pixels, 256U);
  ASSERT_TRUE(reference.targets.front());
  EXPECT_EQ(reference.targets.front()->luminance_ratio, 1.0);
  EXPECT_EQ(reference.targets.front()->contrast_difference, 0.0);
  EXPECT_FALSE(reference.targets.front()->misleads);
}

TEST(Compare, PlainRadiosityDiffersByItsNoiseAlone) {
  const auto builder = room_with_table();
  const Comparison comparison = compared(builder.scene, in_the_room(), {4}, 256);
  const MethodResult& radiosity = comparison.methods[1];
  EXPECT_GT(radiosity.error.error, 0.0);
  // Noise of both pictures together, with a margin for the error of the estimate.
  const double noise = std::hypot(radiosity.frame.report.relative_noise,
                                  comparison.reference().frame.report.relative_noise);
  EXPECT_LT(radiosity.error.error, 1.5 * noise);
  EXPECT_LT(std::abs(radiosity.error.bias), 4.0 * noise / 16.0);  // 256 pixels
}

TEST(Compare, LightThatOnlyReflectionCarriesMisleadsTheApproximation) {
  const auto builder = room_with_table();
  const Comparison comparison = compared(builder.scene, in_the_room(), {16});
  const auto& direct = comparison.methods.back();
  EXPECT_LT(direct.error.bias, -0.1);
  EXPECT_TRUE(direct.targets.front()->misleads);
  const TargetVerdict verdict = judge_approximation(comparison).front();
  EXPECT_EQ(verdict.verdict, ApproximationVerdict::Misled);
  EXPECT_NE(verdict.sentence.find("under the table: 16 distributed lights would have misled"),
            std::string::npos)
      << verdict.sentence;
}

// A single convex plate under a panel has no interreflection: the only error is the number of
// lights.
TEST(Compare, DistributedLightsConverge) {
  auto builder = tests::plate_on_ground(0.0, 0.6);
  builder.scene.lamps.push_back(panel(0.8, 1.0));
  const Comparison comparison =
      compared(builder.scene, tests::above(0.7, 0.9), {4, 16, 64, 256}, 4096);
  double before = std::numeric_limits<double>::infinity();
  for (std::size_t k = 2; k < 6; ++k) {
    const double error = comparison.methods[k].error.error;
    EXPECT_LT(error, 0.7 * before) << comparison.methods[k].method.name;
    before = error;
  }
  EXPECT_LT(before, 0.01);
  const TargetVerdict verdict = judge_approximation(comparison).front();
  EXPECT_EQ(verdict.verdict, ApproximationVerdict::NotMisled) << verdict.sentence;
}

// The plate has only sunlight, the same in every method. A lamp in front of it, half a pixel wide,
// has random samples in every picture.
TEST(Compare, ALampSeenSmallIsNoDifference) {
  const Comparison comparison =
      compared(tests::plate_behind_a_speck(0.03), tests::above(10.0, 2.0), {4});
  EXPECT_LT(comparison.reference_noise, 1e-6);
  EXPECT_EQ(comparison.reference().error.pixels, 63U);
  for (const MethodResult& result : comparison.methods) {
    EXPECT_LT(result.error.high, 1e-6) << result.method.name;
    EXPECT_EQ(result.off_share, 0.0) << result.method.name;
  }
}

// Every wall emits M = 10 lm/m2 and reflects half: B = M + B / 2 = 20, of which 10 is reflected
// light, the reference of errors. Of this, M / 2 = 5, half, is light straight from the sources.
TEST(Compare, ARoomThatGlowsIsComparedByWhatItReflects) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5, 10.0));
  builder.room({m, m, m, m, m, m});
  const MethodResult direct = compared(builder.scene, in_the_room(), {4}).methods.back();
  // 64 rays leave 0.12 of that in each of 256 pixels: four standard errors.
  EXPECT_NEAR(direct.error.bias, -0.5, 4.0 * 0.12 / 16.0);
  EXPECT_GT(direct.off_share, 0.8);
}

TEST(Compare, TargetOutOfViewIsSaidToBe) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.scene.sun = tests::overhead_sun(1000.0);
  scenes::Camera away = tests::above(2.0, 1.0);
  away.look_at = Vec3(9, 0, 9);
  const Comparison comparison = compared(builder.scene, away, {4});
  EXPECT_FALSE(comparison.methods.back().targets.front());
  EXPECT_EQ(comparison.reference().error.pixels, 0U);
  EXPECT_EQ(judge_approximation(comparison).front().sentence, "quad-1: not in view.");
}

TEST(Compare, HiddenTargetIsSaidToBe) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.plate(1, 3.0, 1.0, true);
  const Comparison comparison = compared(builder.scene, tests::above(2.0, 2.0), {4});
  EXPECT_EQ(judge_approximation(comparison).front().sentence, "quad-1: hidden by other objects.");
}

TEST(Compare, SameValuesOnOneAndTwoThreads) {
  const auto builder = room_with_table();
  const auto run = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return compared(builder.scene, in_the_room(), {4});
  };
  const Comparison one = run(1), two = run(2);
  for (std::size_t k = 0; k < one.methods.size(); ++k) {
    EXPECT_EQ(one.methods[k].frame.image.find("G")->values,
              two.methods[k].frame.image.find("G")->values);
    EXPECT_EQ(one.methods[k].error.error, two.methods[k].error.error);
  }
}

TEST(Compare, NumbersOfLightsAreChecked) {
  EXPECT_THROW((void)compare_methods({}), base::Error);
  EXPECT_THROW((void)compare_methods({4, 1}), base::Error);
}

// A factor 2, 1.25 and 0; the sky's 100 does not count. Black in both is no difference.
TEST(OffShare, IsTakenOverWhatShowsAnObject) {
  EXPECT_NEAR(off_share({2, 5, 0, 100}, {1, 4, 2, 0}, {true, true, true, false}), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(off_share({0, 0}, {0, 0}, {true, true}), 0.0);
  EXPECT_EQ(off_share({1, 1}, {0, 0}, {false, false}), 0.0);
}

TEST(TargetDifference, MisleadsBeyondAFactorOrAContrast) {
  const TargetLight right{100.0, 50.0, 1.0};
  const auto misleads = [&](double luminance, std::optional<double> contrast) {
    return target_difference({luminance, 50.0, contrast}, right).misleads;
  };
  EXPECT_FALSE(misleads(149.0, 1.0));
  EXPECT_TRUE(misleads(151.0, 1.0));
  EXPECT_FALSE(misleads(67.0, 1.0));
  EXPECT_TRUE(misleads(66.0, 1.0));
  EXPECT_FALSE(misleads(100.0, 1.09));
  EXPECT_TRUE(misleads(100.0, 1.11));
  EXPECT_TRUE(misleads(100.0, 0.89));
  EXPECT_TRUE(misleads(100.0, std::nullopt));  // a black surround that should not be black
  // Black in both: the ratio has no meaning.
  EXPECT_FALSE(target_difference({0.0, 0.0, {}}, {0.0, 0.0, {}}).misleads);
  EXPECT_TRUE(target_difference({1.0, 0.0, {}}, {0.0, 0.0, {}}).misleads);
}

}  // namespace
}  // namespace earthshine::studies
