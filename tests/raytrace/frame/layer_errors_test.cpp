// SPDX-License-Identifier: Apache-2.0
// The error of a weighted sum of a picture's layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "raytrace/render.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

// The sum of products that a weighted sum has: (w . a)^2 + (w . b)^2 for differences a and b.
TEST(LayerErrors, NoiseOfAWeightedSumIsThatOfItsDifferences) {
  LayerNoise noise;
  const std::array<float, 3> a = {1.0F, -2.0F, 0.5F}, b = {0.0F, 3.0F, -1.0F};
  noise.add(a);
  noise.add(b);
  const std::array<double, 3> weights = {2.0, 1.0, 4.0};
  EXPECT_DOUBLE_EQ(noise.of(weights), 2.0 * 2.0 + 1.0 * 1.0);  // 2 - 2 + 2, 3 - 4
}

// Two parts of the error, each with its noise: 0.01 of the sum of all is noise of the first layer
// alone, 0.04 of the second alone. Weight 0 takes a layer's noise and its light away.
TEST(LayerErrors, EachPartIsScaledByItsOwnNoise) {
  LayerErrors errors;
  errors.luminance = {3.0, 1.0};
  errors.squared = {0.01, 0.04};
  errors.noise.resize(2);
  errors.noise[0].add(std::array<float, 2>{0.5F, 0.0F});
  errors.noise[1].add(std::array<float, 2>{0.0F, 0.1F});
  const auto of = [&](double first, double second) {
    return errors.of(std::array<double, 2>{first, second});
  };
  EXPECT_NEAR(*of(1.0, 1.0), std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(*of(7.0, 7.0), std::sqrt(0.05), 1e-12);
  EXPECT_NEAR(*of(1.0, 0.0), 0.1 * 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(*of(0.0, 1.0), 0.2 * 4.0, 1e-12);
  EXPECT_FALSE(of(0.0, 0.0));
}

// A room by two lamps, one behind a plate: what is stated of each alone, and of one at three times
// its light, is what pictures of other seeds differ by. Squares averaged over pairs of seeds,
// within four standard errors; nothing is shared, which would take its part of the noise.
TEST(LayerErrors, StatedOfASumIsWhatOtherSeedsDifferBy) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({grey, grey, grey, grey, grey, grey});
  builder.plate(grey, 0.3, 0.4, true);
  const auto lamp = [&](const char* name, const Vec3& position, double exitance) {
    scenes::Lamp made;
    made.name = made.group = name;
    made.kind = scenes::LampKind::Disk;
    made.position = position;
    made.axis = Vec3(0, 0, -1);
    made.radius_m = 0.15;
    made.exitance = Rgb(exitance);
    builder.scene.lamps.push_back(made);
  };
  lamp("left", {0.3, 0.5, 0.9}, 3000.0);
  lamp("right", {0.8, 0.7, 0.6}, 500.0);
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
    options.shared.on = true;
    options.shared.smooth_share = 0.0;
    options.shared.noise = 0.1;
    options.per_light = true;
    options.seed = seed;
    return render(prepared, solution, camera, options);
  };
  constexpr std::uint64_t pairs = 16;
  const std::array<std::array<double, 2>, 3> sums = {{{1.0, 0.0}, {0.0, 1.0}, {1.0, 3.0}}};
  std::array<std::vector<double>, 3> off;  // found less stated, squared
  std::array<double, 3> stated{};
  for (std::uint64_t k = 0; k < pairs; ++k) {
    const Frame one = drawn(2 * k + 1), other = drawn(2 * k + 2);
    for (std::size_t s = 0; s < sums.size(); ++s) {
      double squares = 0.0, mean = 0.0;
      for (std::size_t p = 0; p < one.image.pixel_count(); ++p) {
        double difference = 0.0;
        for (std::size_t g = 0; g < 2; ++g) {
          const std::string layer = g == 0 ? "light_left.G" : "light_right.G";
          const double a = double(one.image.find(layer)->values[p]);
          const double b = double(other.image.find(layer)->values[p]);
          difference += sums[s][g] * (a - b);
          mean += sums[s][g] * 0.5 * (a + b);
        }
        squares += 0.5 * difference * difference;
      }
      const auto pixels = double(one.image.pixel_count());
      mean /= pixels;
      const double expected =
          0.5 * (std::pow(*one.layers.of(sums[s]), 2) + std::pow(*other.layers.of(sums[s]), 2));
      off[s].push_back(squares / pixels / (mean * mean) - expected);
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

}  // namespace
}  // namespace earthshine::raytrace
