// SPDX-License-Identifier: Apache-2.0
#include "studies/error_budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "studies/measured_noise.h"
#include "studies/pixel_choice.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

raytrace::RenderOptions small_picture() {
  raytrace::RenderOptions options;
  options.columns = 24;
  options.rows = 20;
  options.gather_rays = 16;
  options.shared.on = true;
  options.shared.noise = 0.03;
  return options;
}

struct Budgeted {
  SecondOpinion opinion;
  ErrorBudget budget;
};
Budgeted budget_of(const tests::SmallRoom& room, const raytrace::RenderOptions& options,
                   const raytrace::Frame& frame) {
  const WatchedPicture picture{&room.camera, options};
  Budgeted made;
  made.opinion = second_opinion(room.study(), room.solution, room.solver, {picture});
  made.budget =
      error_budget(room.study(), made.opinion.pictures.front(), room.solution, picture, frame);
  return made;
}

double luminance(const raytrace::Frame& frame, std::size_t at) {
  return double(frame.image.find("G")->values[at]);  // grey
}

// sqrt(mean (L - R1)(L - R2)) / mean R over pixels that show no source.
double true_error(const raytrace::Frame& frame, const raytrace::Frame& a, const raytrace::Frame& b,
                  const std::vector<std::uint32_t>& pixels) {
  double off = 0.0, mean = 0.0;
  for (const std::uint32_t p : pixels) {
    if (frame.squared_error[p] == raytrace::shows_source) continue;
    off += (luminance(frame, p) - luminance(a, p)) * (luminance(frame, p) - luminance(b, p));
    mean += 0.5 * (luminance(a, p) + luminance(b, p));
  }
  double count = 0.0;
  for (const std::uint32_t p : pixels) {
    if (frame.squared_error[p] != raytrace::shows_source) count += 1.0;
  }
  return std::sqrt(std::max(0.0, off / count)) / (mean / count);
}

TEST(ErrorBudget, OfAPictureLiesWithinItsBound) {
  // Two references of a quarter of the patch edge, four times the rays per patch and 2048 rays per
  // pixel that share nothing.
  const tests::SmallRoom& room = tests::small_room();
  const raytrace::RenderOptions options = small_picture();
  const raytrace::Frame frame = room.picture(options);
  const ErrorBudget budget = budget_of(room, options, frame).budget;
  std::vector<raytrace::Frame> references;
  for (const std::uint64_t seed : {7U, 8U}) {
    radiosity::SolveOptions solver = room.solver;
    solver.patch_edge_m /= 4.0;
    solver.form_factor_rays *= 4;
    solver.seed = seed;
    raytrace::RenderOptions better = options;
    better.shared.on = false;
    better.gather_rays = 2048;
    better.seed = seed;
    references.push_back(raytrace::render(room.scene, room.prepared.groups, room.prepared.effects,
                                          room.prepared.query, room.prepared.solve(solver),
                                          room.camera, better));
  }
  const SurfacePixels seen(room.study(), room.camera, options);
  const double truth = true_error(frame, references[0], references[1], seen.all());
  const Doubt total = budget.parts.total();
  EXPECT_GT(budget.pixels, 300U);
  EXPECT_LE(truth, total.bound_95);
  EXPECT_LT(total.bound_95, 4.0 * truth);
  EXPECT_GT(total.estimate, truth / 2.5);
  EXPECT_LT(total.estimate, truth * 2.5);
  ASSERT_EQ(budget.targets.size(), 1U);
  const TargetError& block = budget.targets.front();
  EXPECT_EQ(block.name, "block");
  EXPECT_EQ(block.pixels, seen.of_object(6).size());
  EXPECT_LE(true_error(frame, references[0], references[1], seen.of_object(6)),
            block.error.bound_95);
}

TEST(ErrorBudget, TakesEachPartFromWhereItWasMeasured) {
  const tests::SmallRoom& room = tests::small_room();
  const raytrace::RenderOptions options = small_picture();
  const raytrace::Frame frame = room.picture(options);
  const Budgeted made = budget_of(room, options, frame);
  const SolutionError& owed = made.opinion.pictures.front().whole;
  const MeasuredNoise noise =
      measure_noise(room.study(), room.solution, {&room.camera, options}, frame,
                    SurfacePixels(room.study(), room.camera, options));
  const ErrorParts& parts = made.budget.parts;
  const auto expect_same = [](const Doubt& a, const Doubt& b) {
    EXPECT_DOUBLE_EQ(a.estimate, b.estimate);
    EXPECT_DOUBLE_EQ(a.bound_95, b.bound_95);
    EXPECT_GT(a.estimate, 0.0);
  };
  expect_same(parts.form_factor_noise, owed.form_factors);
  expect_same(parts.patch_size, owed.patches);
  expect_same(parts.solver_residual, owed.solver);
  expect_same(parts.gather_noise, noise.gather);
  expect_same(parts.camera_samples, noise.camera);
  EXPECT_GT(noise.lamps.estimate, 0.0);
  EXPECT_GT(owed.lamps.estimate, 0.0);
  EXPECT_DOUBLE_EQ(parts.lamp_sampling.estimate,
                   std::hypot(noise.lamps.estimate, owed.lamps.estimate));
  EXPECT_GT(parts.lamp_sampling.estimate, noise.lamps.estimate);
  // A target: its own share of the solution's error beside its noise.
  const TargetError& block = made.budget.targets.front();
  EXPECT_GT(block.error.estimate, made.opinion.pictures.front().targets.at(6).total().estimate);
  EXPECT_GT(made.opinion.pictures.front().targets.at(6).total().estimate, 0.0);
  const PixelMeans means =
      pixel_means(frame, SurfacePixels(room.study(), room.camera, options),
                  SurfacePixels(room.study(), room.camera, options).of_object(6));
  EXPECT_NEAR(
      block.error.estimate,
      std::hypot(noise.correction.estimate * std::sqrt(means.squared_error) / means.luminance,
                 made.opinion.pictures.front().targets.at(6).total().estimate),
      1e-9);
}

TEST(PictureWatch, SeesTheSameSolutionAsTheSame) {
  // Every look has the same rays: what differs is the solutions alone.
  const tests::SmallRoom& room = tests::small_room();
  PictureWatch watch(room.study(), room.solution, room.camera, small_picture(), {30, 200, 310});
  const std::uint64_t rays = watch.rays();
  watch.add(radiosity::Look::FewRays, room.solution);
  EXPECT_EQ(watch.looks().few_rays.front(), watch.looks().own);
  EXPECT_EQ(watch.looks().own.size(), 3U);
  EXPECT_EQ(watch.rays(), 2 * rays);
}

TEST(ErrorBudget, ChangesNeitherPictureNorSolution) {
  const tests::SmallRoom& room = tests::small_room();
  const raytrace::RenderOptions options = small_picture();
  const std::vector<float> radiosity = room.solution.radiosity;
  const raytrace::Frame before = room.picture(options);
  (void)budget_of(room, options, before);
  const raytrace::Frame after = room.picture(options);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(before.image.channels[c].values, after.image.channels[c].values);
  }
  EXPECT_EQ(room.solution.radiosity, radiosity);
}

TEST(ErrorBudget, OfAPictureDoesNotDependOnTheOthersOrOnThreads) {
  const tests::SmallRoom& room = tests::small_room();
  raytrace::RenderOptions options = small_picture(), other = options;
  other.columns = 10;
  other.crop = {2, 3, 5, 6};
  const WatchedPicture first{&room.camera, options}, second{&room.camera, other};
  const auto opinion = [&](int threads, const std::vector<WatchedPicture>& pictures) {
    const base::ThreadLimit limit(threads);
    return second_opinion(room.study(), room.solution, room.solver, pictures);
  };
  const SecondOpinion both = opinion(1, {second, first}), alone = opinion(2, {first});
  ASSERT_EQ(both.pictures.size(), 2U);
  EXPECT_EQ(both.pictures[1].whole.total().estimate, alone.pictures[0].whole.total().estimate);
  EXPECT_EQ(both.pictures[1].whole.total().bound_95, alone.pictures[0].whole.total().bound_95);
  EXPECT_NE(both.pictures[0].whole.total().estimate, alone.pictures[0].whole.total().estimate);
  ASSERT_TRUE(alone.pictures[0].targets.contains(6));
  EXPECT_EQ(both.pictures[1].targets.at(6).total().estimate,
            alone.pictures[0].targets.at(6).total().estimate);
  EXPECT_NE(alone.pictures[0].targets.at(6).total().estimate,
            alone.pictures[0].whole.total().estimate);
  EXPECT_GT(alone.rays, alone.looks.rays);
}

TEST(ErrorBudget, OfATargetIsOverItsOwnPixels) {
  // The bright wall's light is its own more than reflected: of its mean the solution's error is a
  // smaller share than of the picture's.
  scenes::Scene scene = tests::SmallRoom::made();
  scene.objects[0].target = true;
  const tests::SmallRoom room{scene};
  const WatchedErrors errors =
      second_opinion(room.study(), room.solution, room.solver, {{&room.camera, small_picture()}})
          .pictures.front();
  EXPECT_LT(errors.targets.at(0).total().estimate, errors.whole.total().estimate);
  EXPECT_GT(errors.targets.at(0).total().estimate, 0.0);
}

TEST(ErrorBudget, WithoutASolutionNothingIsOwedToIt) {
  const tests::SmallRoom& room = tests::small_room();
  const SecondOpinion none =
      second_opinion(room.study(), {}, room.solver, {{&room.camera, small_picture()}});
  ASSERT_EQ(none.pictures.size(), 1U);
  EXPECT_EQ(none.pictures.front().whole.total().bound_95, 0.0);
  EXPECT_EQ(none.rays, 0U);
}

TEST(ErrorBudget, PartsAddUpInSquares) {
  ErrorParts parts;
  parts.form_factor_noise = {1, 2};
  parts.patch_size = {2, 4};
  parts.solver_residual = {3, 3};
  parts.gather_noise = {4, 5};
  parts.lamp_sampling = {5, 6};
  parts.camera_samples = {6, 7};
  EXPECT_NEAR(parts.total().estimate, std::sqrt(91.0), 1e-12);
  EXPECT_NEAR(parts.total().bound_95, std::sqrt(4.0 + 16 + 9 + 25 + 36 + 49), 1e-12);
}

}  // namespace
}  // namespace earthshine::studies
