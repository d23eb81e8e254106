// SPDX-License-Identifier: Apache-2.0
// The comparison's error without the references' noise, and the sentences for cases that are easily
// got wrong.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random.h"
#include "studies/compare/yardstick.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

struct Normal {
  base::Rng rng;
  double operator()() {  // Box and Muller
    const double u = 1.0 - rng.next(), v = rng.next();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * base::pi * v);
  }
};

// L is off by 0.2 in every pixel and so, by chance, is each reference: with a single one the square
// would be 0.04 + 0.04. It is so far from 0 that it is never clamped there.
TEST(PictureDifference, TwoReferencesLeaveTheErrorWithoutTheirNoise) {
  constexpr std::size_t pixels = 400, pictures = 400;
  const ObjectMap map{20, 20, std::vector<std::int32_t>(pixels, 0)};
  Normal normal{base::Rng(base::Key(1, base::Stream::Pixel, 7))};
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  for (std::size_t picture = 0; picture < pictures; ++picture) {
    std::vector<float> first(pixels), second(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      first[i] = static_cast<float>(1.0 + 0.2 * normal());
      second[i] = static_cast<float>(1.0 + 0.2 * normal());
    }
    const PictureDifference found =
        picture_difference(std::vector<float>(pixels, 1.2F), first, second, map);
    const double mean = 1.2 / (1.0 + found.bias);
    const double square = std::pow(found.relative_rmse * mean, 2);
    sum += square;
    squares += square * square;
    claimed += found.standard_error * mean * 2.0 * 0.2 / pictures;
  }
  const double mean = sum / pictures;
  const double spread = std::sqrt(squares / pictures - mean * mean);
  EXPECT_NEAR(mean, 0.04, 4.0 * spread / std::sqrt(double(pictures)));
  // d sqrt(x) = dx / (2 sqrt(x)); the spread of 400 pictures is known to 1 / sqrt(800).
  EXPECT_NEAR(claimed / spread, 1.0, 4.0 / std::sqrt(800.0) + 0.05);
}

TEST(PictureDifference, NoErrorIsNotMadeOneByTheReferencesNoise) {
  constexpr std::size_t pixels = 10000;
  const ObjectMap map{100, 100, std::vector<std::int32_t>(pixels, 0)};
  Normal normal{base::Rng(base::Key(2, base::Stream::Pixel, 7))};
  std::vector<float> first(pixels), second(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    first[i] = static_cast<float>(1.0 + 0.2 * normal());
    second[i] = static_cast<float>(1.0 + 0.2 * normal());
  }
  const PictureDifference found =
      picture_difference(std::vector<float>(pixels, 1.0F), first, second, map);
  // mean n1 n2 has the standard error 0.2^2 / sqrt(pixels); its root is what could be hidden.
  const double hidden = 0.2 / std::sqrt(std::sqrt(double(pixels)));
  EXPECT_LT(found.relative_rmse, 2.0 * hidden);
  EXPECT_NEAR(std::hypot(found.relative_rmse, found.standard_error + found.relative_rmse), hidden,
              2.0 * hidden);
  EXPECT_NEAR(reference_noise(first, second, map).relative_rmse, 0.2 / std::sqrt(2.0),
              4.0 * 0.2 / std::sqrt(2.0) / std::sqrt(2.0 * pixels) + 0.002);
}

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
  options.shared.on = true;
  options.reference_rays = 256;
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
    EXPECT_EQ(result.difference.relative_rmse, 0.0) << result.method.name;
  }
  EXPECT_EQ(sentence(comparison), "quad-1: black by every method; there is nothing to tell.");
}

// Under a table that hides the lamp all light is reflected: none by direct light.
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

// The mean of two references is off by 2 %: errors below that are named, the reference is not.
TEST(Compare, ErrorsBelowTheReferencesOwnNoiseAreNamed) {
  Comparison comparison;
  comparison.methods.resize(4);
  comparison.methods[1].difference.relative_rmse = 0.01;
  comparison.methods[2].difference.relative_rmse = 0.02;
  comparison.methods[3].difference.relative_rmse = 0.0;
  comparison.reference_noise.relative_rmse = 0.02;
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
