// SPDX-License-Identifier: Apache-2.0
// Verdict sentences for difficult cases.
#include <gtest/gtest.h>

#include "studies/compare/target_differences.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

TEST(Decided, OnlyIfTwiceTheNoiseLeavesTheVerdict) {
  const TargetLight right{100.0, 50.0, 1.0};
  const auto is_decided = [&](double luminance, double ratio_error, double contrast_error = 0.0) {
    TargetDifference difference = target_difference({luminance, 50.0, 1.0}, right);
    difference.ratio_error = ratio_error;
    difference.contrast_error = contrast_error;
    return decided(difference);
  };
  EXPECT_TRUE(is_decided(140.0, 0.0));
  EXPECT_TRUE(is_decided(140.0, 0.04));   // 1.4 + 0.08
  EXPECT_FALSE(is_decided(140.0, 0.06));  // 1.4 + 0.12
  EXPECT_FALSE(is_decided(160.0, 0.06));
  EXPECT_TRUE(is_decided(160.0, 0.04));
  EXPECT_TRUE(is_decided(300.0, 0.5));
  EXPECT_FALSE(is_decided(100.0, 0.0, 0.06));
  EXPECT_TRUE(is_decided(100.0, 0.0, 0.04));
}

scenes::Lamp panel(double exitance) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "panel";
  lamp.kind = scenes::LampKind::Rectangle;
  lamp.position = Vec3(0, 0, 1.5);
  lamp.edge_u = Vec3(0, 0.5, 0);
  lamp.edge_v = Vec3(0.5, 0, 0);
  lamp.axis = Vec3(0, 0, -1);
  lamp.exitance = Rgb(exitance);
  return lamp;
}

Comparison compared(const scenes::Scene& scene) {
  const tests::Prepared prepared(scene);
  CompareOptions options;
  options.columns = options.rows = 16;
  options.gather_rays = 16;
  options.reference_factor = 16;
  options.distributed_lights = {4, 16};
  options.solver.form_factor_rays = 256;
  return compare(prepared, tests::above(1.2, 1.6), options);
}

std::string sentence(const Comparison& comparison) {
  return judge_approximation(comparison).front().sentence;
}

TEST(CompareVerdict, BlackSurfacesLeaveNothingForRadiosityToAdd) {
  auto builder = tests::plate_on_ground(0.0, 0.0);
  builder.scene.lamps.push_back(panel(1000.0));
  const Comparison comparison = compared(builder.scene);
  for (const MethodResult& result : comparison.methods) {
    EXPECT_EQ(result.error.error, 0.0) << result.method.name;
  }
  EXPECT_EQ(sentence(comparison), "quad-1: black by every method; there is nothing to tell.");
}

// Under a table that hides the lamp all light is reflected, none direct.
TEST(CompareVerdict, TargetInFullShadowIsBlackByTheApproximation) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.7));
  builder.room({m, m, m, m, m, m});
  scenes::Material sheet = tests::grey(0.7);
  sheet.two_sided = true;
  const std::uint32_t table = builder.material(sheet);
  builder.quad(table, {0.2, 0.2, 0.3}, {0.8, 0.2, 0.3}, {0.8, 0.8, 0.3}, {0.2, 0.8, 0.3});
  builder.quad(m, {0.45, 0.45, 0.01}, {0.55, 0.45, 0.01}, {0.55, 0.55, 0.01}, {0.45, 0.55, 0.01});
  builder.scene.objects[7].target = true;
  scenes::Lamp lamp = panel(1000.0);
  lamp.position = Vec3(0.5, 0.5, 0.99);
  lamp.edge_u *= 0.2;
  lamp.edge_v *= 0.2;
  builder.scene.lamps.push_back(lamp);
  scenes::Camera camera;
  camera.position = Vec3(0.1, 0.1, 0.25);
  camera.look_at = Vec3(0.5, 0.5, 0.01);
  camera.fov_deg = 40.0;
  const tests::Prepared prepared(builder.scene);
  CompareOptions options;
  options.columns = options.rows = 24;
  options.gather_rays = 64;
  options.distributed_lights = {4};
  options.solver.form_factor_rays = 256;
  const Comparison comparison = compare(prepared, camera, options);
  const TargetVerdict verdict = judge_approximation(comparison).front();
  EXPECT_EQ(verdict.verdict, ApproximationVerdict::Misled);
  EXPECT_NE(verdict.sentence.find("0 instead of"), std::string::npos) << verdict.sentence;
  EXPECT_NE(verdict.sentence.find("(x 0, black)"), std::string::npos) << verdict.sentence;
}

TEST(CompareVerdict, TargetThatIsASourceIsSaidToBe) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.scene.materials[1].emit = Rgb(1000.0);
  tests::SceneBuilder& built = builder;
  const Comparison comparison = compared(built.scene);
  EXPECT_TRUE(comparison.wide_sources);
  const TargetVerdict verdict = judge_approximation(comparison).front();
  EXPECT_EQ(verdict.verdict, ApproximationVerdict::NotMisled) << verdict.sentence;
  EXPECT_EQ(verdict.sentence.rfind("quad-1 (itself a source): 16 distributed lights", 0), 0U)
      << verdict.sentence;
}

TEST(CompareVerdict, WithoutWideSourcesThereIsNothingToDistribute) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.scene.sun = tests::overhead_sun(1000.0);
  const Comparison comparison = compared(builder.scene);
  EXPECT_FALSE(comparison.wide_sources);
  EXPECT_EQ(judge_approximation(comparison).front().verdict, ApproximationVerdict::NotMisled)
      << sentence(comparison);
}

// The mean of two references has an error of 2 %: errors below that are named, the reference is
// not.
TEST(Compare, ErrorsBelowTheReferencesOwnNoiseAreNamed) {
  Comparison comparison;
  comparison.methods.resize(4);
  comparison.methods[1].error.error = 0.01;
  comparison.methods[2].error.error = 0.02;
  comparison.methods[3].error.error = 0.0;
  comparison.reference_noise = 0.02;
  EXPECT_EQ(errors_below_the_references_noise(comparison), (std::vector<std::size_t>{1, 3}));
}

TEST(CompareVerdict, NoiseThatCouldTurnItRoundIsSaid) {
  auto builder = tests::plate_on_ground(0.4, 0.6);
  builder.scene.sun = tests::overhead_sun(1000.0);
  Comparison comparison = compared(builder.scene);
  comparison.methods[3].targets.front()->decided = false;
  const TargetVerdict verdict = judge_approximation(comparison).front();
  EXPECT_EQ(verdict.verdict, ApproximationVerdict::Undecided);
  EXPECT_NE(verdict.sentence.find("too noisy to tell"), std::string::npos) << verdict.sentence;
}

}  // namespace
}  // namespace earthshine::studies
