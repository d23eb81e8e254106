// SPDX-License-Identifier: Apache-2.0
// The error of a weighted sum of a picture's layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// Two layers at two places. The squared errors of the sum of all layers are 0.01, from noise of the
// first layer at the first place, and 0.04, from noise of the second layer at the second place.
// Weight 0 removes a layer's noise and its light.
TEST(LayerErrors, EachPartIsScaledByItsOwnNoise) {
  LayerErrors errors;
  errors.luminance = {3.0, 1.0};
  errors.noise.resize(2);
  errors.noise[0].add({0}, std::array<float, 2>{0.5F, 0.0F});
  errors.noise[1].add({1}, std::array<float, 2>{0.0F, 0.1F});
  for (LayerNoise& part : errors.noise) part.luminance = {3.0F, 1.0F};
  errors.scale_to(std::array<double, 2>{0.01, 0.04}, 3.0 + 1.0);
  const auto of = [&](double first, double second) {
    const auto found = errors.of(std::array<double, 2>{first, second});
    return found ? std::optional(found->relative()) : std::nullopt;
  };
  EXPECT_NEAR(*of(1.0, 1.0), std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(*of(7.0, 7.0), std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(*of(1.0, 0.0), 0.1 * 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(*of(0.0, 1.0), 0.2 * 4.0, 1e-12);
  EXPECT_FALSE(of(0.0, 0.0));
}

// Data of a single place, with 0.01 of the sum of all layers.
LayerErrors errors_of_one_place(const std::array<double, 2>& mean, const std::array<float, 2>& off,
                                const std::array<float, 2>& there) {
  LayerErrors errors;
  errors.luminance.assign(mean.begin(), mean.end());
  errors.noise.resize(1);
  errors.noise[0].add({0}, off);
  errors.noise[0].luminance.assign(there.begin(), there.end());
  errors.scale_to(std::array<double, 1>{0.01}, mean[0] + mean[1]);
  return errors;
}

// Noise of both layers at one place is correlated: (0.5 + 2 * 0.25)^2 over 0.75^2 for all layers.
TEST(LayerErrors, NoiseOfAWeightedSumIsThatOfItsDifferences) {
  const LayerErrors errors = errors_of_one_place({1.0, 1.0}, {0.5F, 0.25F}, {1.0F, 1.0F});
  EXPECT_NEAR(errors.of(std::array<double, 2>{1.0, 2.0})->relative(), 0.1 * 2.0 / 3.0 * 1.0 / 0.75,
              1e-12);
}

// In the sum of both layers the place has the mean luminance and full weight. In the first layer it
// has 40 times the mean and a weight of 1/10.
TEST(LayerErrors, WhereASumIsBrightItsNoiseCountsInProportion) {
  const LayerErrors errors = errors_of_one_place({0.1, 3.9}, {0.5F, 0.0F}, {4.0F, 0.0F});
  EXPECT_NEAR(errors.of(std::array<double, 2>{1.0, 0.0})->relative(), 0.1 * 4.0 / 0.1 * 0.1, 1e-6);
}

// A room with two lamps, one behind a plate, and a small lamp beside a wall, whose spot is a
// hundred times brighter than the rest. The stated error of each layer, and of a sum, equals the
// difference between seeds, with reduced weight for bright pixels. Squares averaged over pairs of
// seeds, within four standard errors; without denoising, which would remove its part of the noise.
TEST(LayerErrors, StatedOfASumIsWhatOtherSeedsDifferBy) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({grey, grey, grey, grey, grey, grey});
  builder.plate(grey, 0.3, 0.4, true);
  const auto lamp = [&](const char* name, const Vec3& position, const Vec3& axis, double radius_m,
                        double exitance) {
    scenes::Lamp made;
    made.name = made.group = name;
    made.kind = scenes::LampKind::Disk;
    made.position = position;
    made.axis = axis;
    made.radius_m = radius_m;
    made.exitance = Rgb(exitance);
    builder.scene.lamps.push_back(made);
  };
  lamp("left", {0.3, 0.5, 0.9}, {0, 0, -1}, 0.15, 3000.0);
  lamp("right", {0.8, 0.7, 0.6}, {0, 0, -1}, 0.15, 500.0);
  lamp("spot", {0.06, 0.5, 0.3}, {-1, 0, 0}, 0.02, 3000.0);
  scenes::Camera camera;
  camera.position = Vec3(0.95, 0.9, 0.5);
  camera.look_at = Vec3(0.3, 0.4, 0.1);
  camera.fov_deg = 60.0;
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.25;
  solve.form_factor_rays = 256;
  const radiosity::Solution solution = prepared.solve(solve);
  const auto drawn = [&](std::uint64_t seed) {
    RenderOptions options;
    options.columns = options.rows = 32;
    options.gather_rays = 16;
    options.denoise = false;
    options.per_light = true;
    options.seed = seed;
    return render(prepared, solution, camera, options);
  };
  constexpr std::uint64_t pairs = 16;
  constexpr std::array<const char*, 3> names = {"light_left.G", "light_right.G", "light_spot.G"};
  const std::array<std::array<double, 3>, 4> sums = {
      {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 3.0, 1.0}, {0.0, 0.0, 1.0}}};
  std::array<std::vector<double>, 4> off;  // squared differences minus stated squares
  std::array<double, 4> stated{};
  for (std::uint64_t k = 0; k < pairs; ++k) {
    const Frame one = drawn(2 * k + 1), other = drawn(2 * k + 2);
    const std::size_t pixels = one.image.pixel_count();
    for (std::size_t s = 0; s < sums.size(); ++s) {
      std::vector<double> difference(pixels, 0.0), both(pixels, 0.0);
      double mean = 0.0, squares = 0.0;
      for (std::size_t p = 0; p < pixels; ++p) {
        for (std::size_t g = 0; g < names.size(); ++g) {
          const double a = double(one.image.find(names[g])->values[p]);
          const double b = double(other.image.find(names[g])->values[p]);
          difference[p] += sums[s][g] * (a - b);
          both[p] += sums[s][g] * 0.5 * (a + b);
        }
        mean += both[p] / double(pixels);
      }
      for (std::size_t p = 0; p < pixels; ++p) {
        squares += 0.5 * std::pow(error_weight(both[p], mean) * difference[p], 2);
      }
      const double expected = 0.5 * (std::pow(one.layers.of(sums[s])->relative(), 2) +
                                     std::pow(other.layers.of(sums[s])->relative(), 2));
      off[s].push_back(squares / double(pixels) / (mean * mean) - expected);
      stated[s] += expected / double(pairs);
    }
  }
  for (std::size_t s = 0; s < sums.size(); ++s) {
    double sum = 0.0, squares = 0.0;
    for (const double x : off[s]) sum += x, squares += x * x;
    const double mean = sum / double(pairs);
    const double error = std::sqrt((squares / double(pairs) - mean * mean) / double(pairs - 1));
    EXPECT_LT(std::abs(mean), 4.0 * error) << s << ": stated " << stated[s];
    EXPECT_LT(error, 0.15 * stated[s]) << s;
  }
}

// The same for a picture drawn to an error, whose rounds add up: for the two lamps together and for
// each. Only the upper bound is a law: later samples go where the sum of all layers needs them,
// which reduces its error more than the layers' errors.
TEST(LayerErrors, StatedOfASumHoldsRoundAfterRound) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({grey, grey, grey, grey, grey, grey});
  builder.plate(grey, 0.3, 0.4, true);
  for (const double x : {0.3, 0.8}) {
    scenes::Lamp lamp;
    lamp.name = lamp.group = x < 0.5 ? "left" : "right";
    lamp.kind = scenes::LampKind::Disk;
    lamp.position = Vec3(x, 0.6, 0.8);
    lamp.axis = Vec3(0, 0, -1);
    lamp.radius_m = 0.15;
    lamp.exitance = Rgb(1000.0);
    builder.scene.lamps.push_back(lamp);
  }
  scenes::Camera camera;
  camera.position = Vec3(0.95, 0.9, 0.5);
  camera.look_at = Vec3(0.3, 0.4, 0.1);
  camera.fov_deg = 60.0;
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  solve.form_factor_rays = 64;
  const radiosity::Solution solution = prepared.solve(solve);
  const auto drawn = [&](std::uint64_t seed) {
    RenderOptions options;
    options.columns = options.rows = 32;
    options.error = 0.02;
    options.per_light = true;
    options.seed = seed;
    return render(prepared, solution, camera, options);
  };
  constexpr std::uint64_t pairs = 12;
  const std::array<std::array<double, 2>, 3> sums = {{{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}};
  std::array<std::vector<double>, 3> off;  // squared differences minus stated squares
  for (std::uint64_t k = 0; k < pairs; ++k) {
    const Frame one = drawn(2 * k + 1), other = drawn(2 * k + 2);
    const std::size_t pixels = one.image.pixel_count();
    for (std::size_t s = 0; s < sums.size(); ++s) {
      double mean = 0.0, squares = 0.0;
      std::vector<double> difference(pixels), both(pixels);
      for (std::size_t p = 0; p < pixels; ++p) {
        const auto sum = [&](const Frame& frame) {
          return sums[s][0] * double(frame.image.find("light_left.G")->values[p]) +
                 sums[s][1] * double(frame.image.find("light_right.G")->values[p]);
        };
        difference[p] = sum(one) - sum(other);
        both[p] = 0.5 * (sum(one) + sum(other));
        mean += both[p] / double(pixels);
      }
      for (std::size_t p = 0; p < pixels; ++p) {
        squares += 0.5 * std::pow(error_weight(both[p], mean) * difference[p], 2);
      }
      const double stated = 0.5 * (std::pow(one.layers.of(sums[s])->relative(), 2) +
                                   std::pow(other.layers.of(sums[s])->relative(), 2));
      EXPECT_GT(stated, 0.0);
      off[s].push_back(squares / double(pixels) / (mean * mean) - stated);
    }
  }
  for (const std::vector<double>& of_sum : off) {
    double sum = 0.0, squares = 0.0;
    for (const double x : of_sum) sum += x, squares += x * x;
    const double mean = sum / double(pairs);
    const double error = std::sqrt((squares / double(pairs) - mean * mean) / double(pairs - 1));
    EXPECT_LT(mean, 4.0 * error);
  }
}

// Two regions of a picture with four columns. The mean over the first, of two pixels, has half of
// the noise of each of its places. A place that serves four pixels, three of them in the second
// region of four, contributes three quarters of its noise. Rounds of one place add up.
TEST(RegionNoise, VarianceOfAMeanIsThatOfIndependentPlaces) {
  LayerErrors errors;
  errors.luminance = {1.0, 1.0};
  errors.noise.resize(2);
  errors.noise[0].add({0}, std::array<float, 2>{0.5F, 0.25F});
  errors.noise[0].add({1}, std::array<float, 2>{0.0F, 1.0F});
  errors.noise[0].add({1}, std::array<float, 2>{1.0F, 0.0F});
  errors.noise[1].edge_px = 2;  // pixels 10, 11, 14, 15
  errors.noise[1].add({15}, std::array<float, 2>{2.0F, 0.0F});
  const std::array<std::vector<std::uint32_t>, 2> regions = {{{0, 1}, {9, 10, 11, 14}}};
  const RegionNoise noise(errors, regions, 4);
  EXPECT_EQ(noise.covariance.size(), 2U * 3U);
  const std::vector<double> variances = noise.variances(std::array<double, 2>{1.0, 2.0});
  EXPECT_NEAR(variances[0], 0.25 * (1.0 + 4.0 + 1.0), 1e-9);
  EXPECT_NEAR(variances[1], std::pow(0.75 * 2.0, 2), 1e-9);
}

// One gather point for four pixels: the picture of a room with a lamp differs from one with a point
// per pixel by no more than both stated errors, within four standard errors of the mean.
TEST(GatherStep, ACoarserFieldShowsTheSameLight) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({grey, grey, grey, grey, grey, grey});
  builder.plate(grey, 0.3, 0.4, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = Vec3(0.5, 0.5, 0.95);
  lamp.axis = Vec3(0, 0, -1);
  lamp.radius_m = 0.2;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  scenes::Camera camera;
  camera.position = Vec3(0.95, 0.9, 0.5);
  camera.look_at = Vec3(0.3, 0.4, 0.1);
  camera.fov_deg = 60.0;
  const tests::Prepared prepared(builder.scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  solve.form_factor_rays = 64;
  const radiosity::Solution solution = prepared.solve(solve);
  const auto mean_of = [&](int step, std::uint64_t seed) {
    RenderOptions options;
    options.columns = options.rows = 32;
    options.error = 0.05;
    options.gather_step = step;
    options.seed = seed;
    const Frame frame = render(prepared, solution, camera, options);
    double sum = 0.0;
    for (const float value : frame.image.find("G")->values) sum += double(value);
    return sum / double(frame.image.pixel_count());
  };
  constexpr int seeds = 8;
  double sum = 0.0, squares = 0.0, level = 0.0;
  for (int k = 0; k < seeds; ++k) {
    const auto seed = static_cast<std::uint64_t>(k) + 1;
    const double fine = mean_of(1, seed), coarse = mean_of(2, seed + 100);
    sum += coarse - fine, squares += (coarse - fine) * (coarse - fine), level += fine / seeds;
  }
  const double mean = sum / seeds;
  const double error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
  EXPECT_LT(std::abs(mean), 4.0 * error);
  EXPECT_LT(error, 0.02 * level);
}

}  // namespace
}  // namespace earthshine::raytrace
