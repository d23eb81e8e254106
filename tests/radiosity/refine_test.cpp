// SPDX-License-Identifier: Apache-2.0
#include "radiosity/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "radiosity/variation.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

SolveOptions refining(double start_edge_m, std::size_t max_patches, double error = 0.0) {
  SolveOptions options;
  options.form_factor_rays = 256;
  options.patch_edge_m = start_edge_m / 8;
  options.refine = {true, start_edge_m, max_patches, error};
  return options;
}

scenes::Sun sun_toward(const Vec3& direction) {
  scenes::Sun sun;
  sun.direction = glm::normalize(direction);
  sun.angular_radius_deg = 0.0;
  return sun;
}

scenes::Lamp lamp_at(const Vec3& position, double intensity_cd) {
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = position;
  lamp.intensity_cd = Rgb(intensity_cd);
  return lamp;
}

// A plate of 1 m in the Sun under a black plate of 0.4 m, which casts an oblique shadow on it.
scenes::Scene shadowed_plate() {
  tests::SceneBuilder builder;
  const std::uint32_t white = builder.material(tests::grey(0.5));
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.plate(white, 1.0, 0.0, true);
  builder.quad(black, {-0.2, 0, 0.3}, {0, -0.17, 0.3}, {0.2, 0, 0.3}, {0, 0.23, 0.3});
  builder.scene.sun = sun_toward({0.1, 0.05, 1});
  return builder.scene;
}

// Mean over the plate of (B - true B)^2 / mean of B^2; B is 1 in the Sun and 0 in the shadow.
double relative_error(const tests::Prepared& prepared, const Solution& solution) {
  constexpr int n = 400;
  const scenes::Scene& scene = prepared.scene;
  const double lit = 0.5 * scene.sun->illuminance_lx.g * scene.sun->direction.z;
  double error = 0.0, all = 0.0;
  for (int k = 0; k < n * n; ++k) {
    const double s = (k / n + 0.5) / n, t = (k % n + 0.5) / n;
    const Vec3 at(s - 0.5, t - 0.5, 1e-5);
    const double truth = prepared.query.closest(at, scene.sun->direction).missed() ? 1.0 : 0.0;
    const std::uint32_t patch = solution.patches.leaf(solution.patches.facets[0], {s, t});
    const double b = double(solution.radiosity[patch * solution.columns + 1]) / lit;
    error += (b - truth) * (b - truth);
    all += truth;
  }
  return std::sqrt(error / all);
}

TEST(Refine, AShadowsEdgeNeedsAThirdOfTheEvenPatchesAndLess) {
  // The error of uniform patches of edge h decreases as sqrt(h), with cells along the shadow's edge
  // as 1 / N.
  const scenes::Scene scene = shadowed_plate();
  const tests::Prepared prepared(scene);
  SolveOptions even = refining(1.0, 0);
  even.refine.on = false;
  even.patch_edge_m = 1.0 / 32;
  const Solution grid = prepared.solve(even);
  ASSERT_GT(grid.report.patches, 1024U);
  const Solution refined = prepared.solve(refining(0.25, 341));
  EXPECT_LE(refined.report.patches, 341U);
  EXPECT_LT(relative_error(prepared, refined), relative_error(prepared, grid));
}

TEST(Refine, TheEstimateIsTheErrorOfShadowEdgesWithinAFifth) {
  const scenes::Scene scene = shadowed_plate();
  const tests::Prepared prepared(scene);
  const Solution refined = prepared.solve(refining(0.25, 400));
  // The relative error refers to all radiosity; the blocker has none, and its area cancels.
  EXPECT_NEAR(refined.report.rounds.back().error / relative_error(prepared, refined), 1.0, 0.2);
}

TEST(Refine, EachRoundHasMorePatchesAndInTheEndLessError) {
  const scenes::Scene scene = shadowed_plate();
  const Solution refined = tests::Prepared(scene).solve(refining(0.25, 1000));
  const std::vector<RefineRound>& rounds = refined.report.rounds;
  ASSERT_GT(rounds.size(), 3U);
  for (std::size_t k = 1; k < rounds.size(); ++k) {
    EXPECT_GT(rounds[k].patches, rounds[k - 1].patches);
  }
  EXPECT_EQ(rounds.back().patches, refined.patches.count());
  EXPECT_LT(rounds.back().error, 0.4 * rounds.front().error);
}

TEST(Refine, EndsAtTheErrorAskedFor) {
  const scenes::Scene scene = shadowed_plate();
  const Solution refined = tests::Prepared(scene).solve(refining(0.25, 100000, 0.1));
  EXPECT_LE(refined.report.rounds.back().error, 0.1);
  ASSERT_GT(refined.report.rounds.size(), 1U);
  EXPECT_GT(refined.report.rounds[refined.report.rounds.size() - 2].error, 0.1);
}

TEST(Refine, TheBudgetHoldsForSheetsToo) {
  scenes::Scene scene = shadowed_plate();
  for (scenes::Material& material : scene.materials) material.two_sided = true;
  const tests::Prepared prepared(scene);
  for (const std::size_t budget : {68U, 69U, 100U, 333U}) {
    const std::size_t count = prepared.solve(refining(0.25, budget)).report.patches;
    EXPECT_LE(count, budget);
    EXPECT_GE(static_cast<double>(count), 0.95 * static_cast<double>(budget));
  }
}

TEST(Refine, EvenLightIsLeftAloneHoweverFewTheRays) {
  // M = 1 - rho in a closed room: B = 1 on every wall for any reflectance.
  tests::SceneBuilder builder;
  std::array<std::uint32_t, 6> walls{};
  for (std::size_t k = 0; k < 6; ++k) {
    const double rho = 0.15 * static_cast<double>(k);
    walls[k] = builder.material(tests::grey(rho, 1.0 - rho));
  }
  builder.room(walls);
  SolveOptions options = refining(0.5, 5000);
  options.form_factor_rays = 64;
  const Solution solution = tests::Prepared(builder.scene).solve(options);
  EXPECT_EQ(solution.report.rounds.size(), 1U);
  EXPECT_EQ(solution.report.patches, 6U * 4U);
  EXPECT_LT(solution.report.rounds.back().error, 1e-6);
}

TEST(Refine, NoiseOfAFewRaysIsNotTakenForLight) {
  // A room with soft light from a whole wall: few rays find no more to refine than many.
  tests::SceneBuilder builder;
  const std::uint32_t dim = builder.material(tests::grey(0.6));
  const std::uint32_t lit = builder.material(tests::grey(0.2, 1.0));
  builder.room({dim, lit, dim, dim, dim, dim});
  const tests::Prepared prepared(builder.scene);
  std::array<double, 2> error{};
  for (std::size_t k = 0; k < 2; ++k) {
    SolveOptions options = refining(0.25, 700);
    options.form_factor_rays = k == 0 ? 64 : 4096;
    error[k] = prepared.solve(options).report.rounds.back().error;
  }
  EXPECT_LT(error[0], 1.1 * error[1]);
}

TEST(Refine, AFaintLampCountsLikeTheSun) {
  // One plate with the Sun's hard shadow, another one below under a lamp 1e9 times fainter.
  scenes::Scene scene = shadowed_plate();
  tests::SceneBuilder builder;
  builder.scene = scene;
  builder.plate(0, 1.0, -1.0, false);
  builder.scene.lamps.push_back(lamp_at({0.2, 0.2, -1.1}, 1e-4));
  const Solution refined = tests::Prepared(builder.scene).solve(refining(0.25, 1600));
  const Patches& patches = refined.patches;
  EXPECT_GT(patches.facets[0].leaves, 50U);
  EXPECT_GT(patches.facets.back().leaves, 50U);
}

TEST(Refine, ATinyTriangleInTheShadowsEdgeIsLeftWhole) {
  // 2 mm wide in the same light as the plate: its error is 1e-6 of the plate's.
  tests::SceneBuilder builder;
  builder.scene = shadowed_plate();
  const double h = 0.001;
  builder.quad(0, {-h, 0.2 - h, 1e-3}, {h, 0.2 - h, 1e-3}, {h, 0.2 + h, 1e-3}, {-h, 0.2 + h, 1e-3});
  const Solution refined = tests::Prepared(builder.scene).solve(refining(0.25, 500));
  EXPECT_EQ(refined.patches.facets.back().leaves, 1U);
}

TEST(Refine, LightThroughASmallWindowIsFound) {
  // A black box of 1 m around a white floor, with a hole of 6 cm in its lid: 16 points on cells of
  // half a metre miss the spot on the floor, and a solution without light has no error estimate.
  tests::SceneBuilder builder;
  const std::uint32_t white = builder.material(tests::grey(0.5));
  scenes::Material sheet = tests::grey(0.0);
  sheet.two_sided = true;
  const std::uint32_t lid = builder.material(sheet);
  builder.plate(white, 1.0, 0.0, true);
  const double a = 0.31, b = 0.37, far = 2.0, z = 0.2;
  builder.quad(lid, {-far, -far, z}, {far, -far, z}, {far, a, z}, {-far, a, z});
  builder.quad(lid, {-far, b, z}, {far, b, z}, {far, far, z}, {-far, far, z});
  builder.quad(lid, {-far, a, z}, {a, a, z}, {a, b, z}, {-far, b, z});
  builder.quad(lid, {b, a, z}, {far, a, z}, {far, b, z}, {b, b, z});
  builder.scene.sun = sun_toward({0, 0, 1});
  SolveOptions options = refining(0.5, 5000, 0.05);
  options.patch_edge_m = 0.05;
  const Solution refined = tests::Prepared(builder.scene).solve(options);
  double landed_lm = 0.0;
  for (std::size_t i = 0; i < refined.patches.facets[0].leaves; ++i) {
    landed_lm += 2.0 * refined.patches.area_m2[i] * double(refined.radiosity[i * 3 + 1]);
  }
  // 133 100 lx on 36 cm2, except for the part on cells that the spot's edge crosses.
  EXPECT_NEAR(landed_lm / (133100.0 * 0.06 * 0.06), 1.0, 0.05);
}

TEST(Refine, NothingIsDoneWithoutLight) {
  scenes::Scene scene = shadowed_plate();
  scene.sun.reset();
  const Solution solution = tests::Prepared(scene).solve(refining(0.25, 400));
  EXPECT_TRUE(solution.report.rounds.empty());
  EXPECT_EQ(solution.report.refinement_rays, 0U);
}

TEST(Refine, SamePatchesAndLightOnOneAndFourThreads) {
  const scenes::Scene scene = shadowed_plate();
  const tests::Prepared prepared(scene);
  std::vector<Solution> solutions;
  for (const int threads : {1, 4}) {
    const base::ThreadLimit limit(threads);
    solutions.push_back(prepared.solve(refining(0.25, 600)));
  }
  EXPECT_EQ(solutions[0].patches.area_m2, solutions[1].patches.area_m2);
  EXPECT_EQ(solutions[0].patches.tree, solutions[1].patches.tree);
  EXPECT_EQ(solutions[0].radiosity, solutions[1].radiosity);
}

TEST(Variation, HalvingAcrossAGradientTakesThreeQuartersOfItsErrorAway) {
  // A lamp far to the side of a small plate: E decreases linearly along x except for second-order
  // terms. Halving along x leaves a quarter of the variance, halving along y all of it.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.2, 0.0, true);
  builder.scene.lamps.push_back(lamp_at({1, 0, 1}, 100.0));
  const tests::Prepared prepared(builder.scene);
  SolveOptions options;
  options.patch_edge_m = 1.0;
  const Solution solution = prepared.solve(options);
  ASSERT_EQ(solution.patches.count(), 1U);
  Variation variation(prepared, {0.01});
  const std::vector<std::uint32_t> all{0};
  const Unevenness found = variation.find(solution.patches, all, relative_light(solution)).front();
  // E = I h / d^3: dE/dx / E = 3 dx / d^2 = 3 / 2 per m at the centre; variance of a linear
  // function over the width w: (3/2 w)^2 / 12.
  EXPECT_NEAR(found.error / (0.09 / 12.0), 1.0, 0.05);
  EXPECT_NEAR(found.along_s / found.error, 0.75, 0.03);
  EXPECT_LT(found.along_t, 0.01 * found.error);
}

}  // namespace
}  // namespace earthshine::radiosity
