// SPDX-License-Identifier: Apache-2.0
#include "studies/accuracy/accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "base/numbers/random.h"
#include "tests/studies/plates.h"

namespace earthshine::studies {
namespace {

// Nearly normal, variance 1.
double normal(base::Rng& rng) {
  double sum = -6.0;
  for (int j = 0; j < 12; ++j) sum += rng.next();
  return sum;
}

NoisyPicture noisy(std::size_t pixels, double truth, double sigma, std::uint64_t seed) {
  NoisyPicture picture{std::vector<double>(pixels), std::vector<double>(pixels, sigma * sigma)};
  base::Rng rng(base::Key(seed, base::Stream::Test, 0));
  for (double& value : picture.luminance) value = truth + sigma * normal(rng);
  return picture;
}

constexpr std::size_t pixels = 4096;
const std::vector<bool> all_pixels(pixels, true);

// L is 10 + d, the references are 10 with noise s = 2: mean (L - R1)(L - R2) = d^2 for any noise,
// with the variance (2 d^2 s^2 + s^4) / pixels; d = 0.5, s = 2: (2 + 16) / 4096, so 0.066 on 0.25.
TEST(PictureError, NoiseOfTheReferencesIsTakenOff) {
  const ReferencePair truth{noisy(pixels, 10.0, 2.0, 1), noisy(pixels, 10.0, 2.0, 2)};
  const std::vector<float> picture(pixels, 10.5F);
  const PictureError error = picture_error(picture, truth, all_pixels);
  EXPECT_EQ(error.pixels, pixels);
  const double standard_error = std::sqrt(18.0 / pixels);
  EXPECT_NEAR(std::pow(10.0 * error.error, 2), 0.25, 4.0 * standard_error);
  EXPECT_NEAR(std::pow(10.0 * error.high, 2) - std::pow(10.0 * error.error, 2),
              2.0 * standard_error, 0.5 * standard_error);
  EXPECT_NEAR(error.bias, 0.05, 4.0 * 2.0 / std::sqrt(2.0 * pixels) / 10.0);
  // One noisy reference alone would give sqrt(0.25 + 4) / 10.
  EXPECT_LT(error.high, 0.1);
}

// The same without the variances. The standard error equals the spread over many pairs,
// d sqrt(x) = dx / (2 sqrt(x)). L has an error of 0.2 in every pixel, and each reference has random
// errors of this size. The square, 0.04, has the standard error sqrt((2 + 1) 0.2^4 / 400) and is
// never clamped at 0.
TEST(PictureError, WithoutVariancesThePairTellsItsNoise) {
  constexpr std::size_t few = 400, pairs = 400;
  const auto unknown = [](std::uint64_t seed) {
    NoisyPicture picture = noisy(few, 1.0, 0.2, seed);
    picture.variance.clear();
    return picture;
  };
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  for (std::uint64_t k = 0; k < pairs; ++k) {
    const ReferencePair truth{unknown(200 + 2 * k), unknown(201 + 2 * k)};
    const PictureError found =
        picture_error(std::vector<float>(few, 1.2F), truth, std::vector<bool>(few, true));
    const double mean = 1.2 / (1.0 + found.bias);
    const double square = std::pow(found.error * mean, 2);
    sum += square;
    squares += square * square;
    claimed += found.standard_error * mean * 2.0 * 0.2 / pairs;
  }
  const double mean = sum / pairs;
  const double spread = std::sqrt(squares / pairs - mean * mean);
  EXPECT_NEAR(mean, 0.04, 4.0 * spread / std::sqrt(double(pairs)));
  // The spread of 400 pictures has the relative error 1 / sqrt(800).
  EXPECT_NEAR(claimed / spread, 1.0, 4.0 / std::sqrt(2.0 * pairs) + 0.05);
}

// An exact picture, without the variances: mean n1 n2 has the standard error 0.2^2 / sqrt(pixels),
// whose root is the least detectable error. Half the difference of the pair has the noise of their
// mean.
TEST(PictureError, NoErrorIsNotMadeOneByThePairsNoise) {
  constexpr std::size_t many = 10000;
  ReferencePair truth{noisy(many, 1.0, 0.2, 101), noisy(many, 1.0, 0.2, 102)};
  truth.first.variance.clear();
  truth.second.variance.clear();
  const std::vector<bool> all(many, true);
  const PictureError found = picture_error(std::vector<float>(many, 1.0F), truth, all);
  const double hidden = 0.2 / std::sqrt(std::sqrt(double(many)));
  EXPECT_LT(found.error, 2.0 * hidden);
  EXPECT_NEAR(found.standard_error + found.error, hidden, hidden);
  EXPECT_NEAR(noise_of_mean(truth, all), 0.2 / std::sqrt(2.0),
              4.0 * 0.2 / std::sqrt(2.0) / std::sqrt(2.0 * many) + 0.002);
}

// Without noise: differences 1, 1 and -2 on a mean of 7 / 3, without the pixel that does not count.
// Then nine pixels of 1 and one of 91, mean 10, each with an error of a tenth: the bright one, 9.1
// times the mean, has the weight 4 / 9.1, (9 * 0.1^2 + 4^2) / 10 on a mean of 10.
TEST(PictureError, CountsBrightPixelsInProportion) {
  const auto exact = [](const std::vector<double>& values) {
    const NoisyPicture picture{values, {}};
    return ReferencePair{picture, picture};
  };
  const PictureError plain =
      picture_error({2, 5, 0, 100}, exact({1, 4, 2, 0}), {true, true, true, false});
  EXPECT_EQ(plain.pixels, 3U);
  EXPECT_NEAR(plain.error, std::sqrt(6.0 / 3.0) / (7.0 / 3.0), 1e-12);
  EXPECT_NEAR(plain.bias, 0.0, 1e-12);
  std::vector<double> truth(10, 1.0);
  truth.back() = 91.0;
  std::vector<float> picture(10, 1.1F);
  picture.back() = 100.1F;
  const PictureError bright = picture_error(picture, exact(truth), std::vector<bool>(10, true));
  EXPECT_NEAR(bright.error, std::sqrt((9 * 0.01 + 16.0) / 10.0) / 10.0, 1e-6);
}

// An exact picture: 2 s = 2 sigma^2 / sqrt(pixels); the resolution is its root over the mean.
TEST(PictureError, ResolutionIsWhatNoiseCouldFeign) {
  const ReferencePair truth{noisy(pixels, 10.0, 2.0, 3), noisy(pixels, 10.0, 2.0, 4)};
  const double expected = std::sqrt(2.0 * 4.0 / std::sqrt(double(pixels))) / 10.0;
  EXPECT_NEAR(resolution(truth, all_pixels), expected, 0.02 * expected);
  int within = 0;
  for (std::uint64_t seed = 10; seed < 110; seed += 2) {
    const ReferencePair other{noisy(pixels, 10.0, 2.0, seed), noisy(pixels, 10.0, 2.0, seed + 1)};
    const PictureError error = picture_error(std::vector<float>(pixels, 10.0F), other, all_pixels);
    within += error.error <= resolution(other, all_pixels) ? 1 : 0;
  }
  EXPECT_GE(within, 44);  // of 50; two standard errors on one side: 97.7 %, minus 4 binomial ones
}

// The limit's pictures and the truth differ by 1; both are noisy: mean (D1 - R1)(D2 - R2) = 1.
TEST(PictureError, LimitIsTheDifferenceOfTwoTruths) {
  const ReferencePair truth{noisy(pixels, 10.0, 2.0, 5), noisy(pixels, 10.0, 2.0, 6)};
  const ReferencePair limit{noisy(pixels, 11.0, 1.0, 7), noisy(pixels, 11.0, 1.0, 8)};
  const PictureError error = limit_error(limit, truth, all_pixels);
  const double standard_error = std::sqrt((2.0 * 5.0 + 25.0) / pixels);
  EXPECT_NEAR(std::pow(10.0 * error.error, 2), 1.0, 4.0 * standard_error);
  EXPECT_EQ(limit_error(truth, truth, all_pixels).error, 0.0);
}

TEST(PictureError, BlackOrNoPixelsHaveNoError) {
  const NoisyPicture black{std::vector<double>(4), std::vector<double>(4)};
  const PictureError dark = picture_error({0, 0, 0, 0}, {black, black}, std::vector<bool>(4, true));
  EXPECT_EQ(dark.error, 0.0);
  EXPECT_EQ(dark.high, 0.0);
  const PictureError none = picture_error({0, 0, 0, 0}, {black, black}, std::vector<bool>(4));
  EXPECT_EQ(none.pixels, 0U);
  EXPECT_EQ(none.error, 0.0);
  EXPECT_EQ(resolution({black, black}, std::vector<bool>(4)), 0.0);
}

// First round: 16 paths have 4 times the wanted error, so that 16 times the paths are needed in
// all.
TEST(Reference, BatchesBringTheNoiseDownByTheRootOfThePaths) {
  const std::vector<int> batches = further_batches(16, 0.04, 0.01, 1 << 14);
  int paths = 16;
  for (const int batch : batches) paths += batch;
  EXPECT_EQ(paths, 256);
  EXPECT_EQ(*std::max_element(batches.begin(), batches.end()), 64);
  EXPECT_TRUE(further_batches(16, 0.01, 0.01, 1 << 14).empty());
  EXPECT_TRUE(further_batches(16, 0.01, 0.0, 1 << 14).empty());
  int most = 16;
  for (const int batch : further_batches(16, 1.0, 1e-6, 500)) most += batch;
  EXPECT_LE(most, 501);  // a batch has at least two paths
}

TEST(Reference, MeanOfBatchesWeighsByPaths) {
  const base::Image one{1, 1, {{"Y", {1.0F}}, {"variance", {4.0F}}, {"counts", {1.0F}}}};
  const base::Image two{1, 1, {{"Y", {5.0F}}, {"variance", {8.0F}}, {"counts", {0.0F}}}};
  const NoisyPicture mean = mean_of_batches(
      {{raytrace::PathSet::All, 0, 0, 16}, {raytrace::PathSet::All, 0, 1, 48}}, {one, two});
  EXPECT_DOUBLE_EQ(mean.luminance[0], 0.25 * 1.0 + 0.75 * 5.0);
  EXPECT_DOUBLE_EQ(mean.variance[0], 0.0625 * 4.0 + 0.5625 * 8.0);
  EXPECT_FALSE(mean.counts[0]);  // one of the batches saw an edge of a source
}

TEST(Reference, SeedsAreAllDifferent) {
  std::set<std::uint64_t> seeds = {1, 2};
  for (const std::uint64_t seed : {1U, 2U}) {
    for (int side = 0; side < 2; ++side) {
      for (int index = 0; index < 50; ++index) seeds.insert(reference_seed(seed, side, index));
    }
  }
  EXPECT_EQ(seeds.size(), 202U);
}

scenes::Scene plate_under_earth() {
  scenes::Scene scene = tests::plate_on_ground(0.5, 0.2).scene;
  scenes::Earth earth;
  earth.half_angle_deg = 60.0;
  earth.model = scenes::EarthModel::Uniform;
  earth.radiance = Rgb(100.0);
  scene.earth = earth;
  return scene;
}

// Paths against themselves: the error of n paths is their noise, sigma / sqrt(n). 4 and 64 paths
// differ by a factor of 4 in the error.
TEST(Accuracy, PathsErrorFallsWithTheirRoot) {
  const scenes::Scene scene = plate_under_earth();
  const tests::Prepared prepared(scene);
  const scenes::World study = prepared;
  AccuracyView view = accuracy_view(tests::above(10.0, 2.0), 24, 24, 1);
  const auto side = [&](int k) {
    const Batch batch{raytrace::PathSet::All, k, 0, 256};
    return mean_of_batches({batch}, {*trace_batch(study, view, batch)});
  };
  const ReferencePair truth{side(0), side(1)};
  const std::vector<bool> counted = counted_pixels(truth);
  double errors[2];
  for (const int k : {0, 1}) {
    AccuracyStep step;
    step.method = "paths";
    step.series = series::samples;
    step.indirect = raytrace::Indirect::Paths;
    step.quality.gather_rays = k == 0 ? 4 : 64;
    SolutionShelf shelf;
    const auto result = run_step(study, view, step, shelf);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->cost.patches, 0U);
    EXPECT_GT(result->cost.cpu_seconds, 0.0);
    EXPECT_GT(result->cost.memory_bytes, 0.0);
    errors[k] = picture_error(result->luminance, truth, counted).error;
  }
  // The square of either has a relative error of sqrt(2 / 576).
  EXPECT_NEAR(errors[0] / errors[1], 4.0,
              4.0 * 4.0 * std::sqrt(2.0 / 576.0) / 2.0 * std::sqrt(2.0));
}

// A lamp 0.16 pixels wide covers 0.02 of one of the plate's 64 pixels: with its light the mean
// would be 1.6 times as high, if paths hit it. Without it the pixels have 500 / pi, and all light
// is direct.
TEST(Accuracy, ALampSeenSmallIsNoPartOfTheTruth) {
  const scenes::Scene scene = tests::plate_behind_a_speck(0.01);
  const tests::Prepared prepared(scene);
  const AccuracyView view = accuracy_view(tests::above(10.0, 2.0), 16, 16, 1);
  const auto side = [&](int k) {
    const Batch batch{raytrace::PathSet::All, k, 0, 256};
    return mean_of_batches({batch}, {*trace_batch(prepared, view, batch)});
  };
  const ReferencePair truth{side(0), side(1)};
  const std::vector<bool> counted = counted_pixels(truth);
  EXPECT_EQ(std::count(counted.begin(), counted.end(), true), 63);
  EXPECT_NEAR(mean_luminance(truth, counted), 500.0 / base::pi, 1e-4);
  EXPECT_LT(resolution(truth, counted), 1e-6);
  AccuracyStep step;
  step.indirect = raytrace::Indirect::None;
  SolutionShelf shelf;
  const auto result = run_step(prepared, view, step, shelf);
  ASSERT_TRUE(result);
  EXPECT_LT(picture_error(result->luminance, truth, counted).high, 1e-6);
}

// A caller may wrap every solve; the result of an interrupted solve is discarded. The shelf's
// solution is not solved again.
TEST(Accuracy, EverySolveIsTheCallersToWatch) {
  const scenes::Scene scene = plate_under_earth();
  const tests::Prepared prepared(scene);
  const scenes::World study = prepared;
  AccuracyView view = accuracy_view(tests::above(10.0, 2.0), 4, 4, 1);
  int solves = 0;
  view.while_solving = [&](const std::function<void()>& solve) {
    ++solves;
    solve();
  };
  AccuracyStep step;
  step.quality.patch_edge_m = 1.0;
  step.quality.gather_rays = 2;
  SolutionShelf shelf;
  ASSERT_TRUE(run_step(study, view, step, shelf));
  EXPECT_EQ(solves, 1);
  ASSERT_TRUE(run_step(study, view, step, shelf));
  EXPECT_EQ(solves, 1);
  step.quality.error = 0.5;
  ASSERT_TRUE(run_step(study, view, step, shelf));
  EXPECT_EQ(solves, 2);
}

}  // namespace
}  // namespace earthshine::studies
