// SPDX-License-Identifier: Apache-2.0
// Pictures under a sky in parts: with the same rays the layers of the parts add up to the picture
// under the whole sky.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "raytrace/render.h"
#include "scenes/sky/sky_cells.h"
#include "tests/support/scene_builder.h"
#include "tests/support/sky_in_parts.h"

namespace earthshine::raytrace {
namespace {

// A plate, a glossy plate and a mirror on edge, in front of the Earth's disc.
scenes::Scene things() {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.6)), 4.0, 0.0, true);
  scenes::Material glossy = tests::grey(0.3);
  glossy.specular = Rgb(0.4);
  glossy.shininess = 20.0;
  const std::uint32_t g = builder.material(glossy);
  builder.quad(g, {-1, 1, 0}, {1, 1, 0}, {1, 1, 1}, {-1, 1, 1});
  builder.quad(g, {-1, 1, 1}, {1, 1, 1}, {1, 1, 0}, {-1, 1, 0});
  scenes::Material mirror = tests::grey(0.1);
  mirror.mirror = Rgb(0.7);
  builder.quad(builder.material(mirror), {-1, -1, 0}, {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 1});
  return builder.scene;
}

scenes::Camera looking_up() {
  scenes::Camera camera;
  camera.position = Vec3(1.5, -1.8, 0.7);
  camera.look_at = Vec3(-0.3, 1, 0.6);
  camera.fov_deg = 70.0;
  return camera;
}

Frame drawn(const scenes::Scene& scene, bool per_light, std::uint64_t seed = 1) {
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  solve.form_factor_rays = 256;
  solve.tolerance = 1e-13;
  RenderOptions options;
  options.columns = options.rows = 24;
  options.gather_rays = 64;
  options.denoise = false;
  options.seed = seed;
  options.per_light = per_light;
  return render(prepared, prepared.solve(solve), looking_up(), options);
}

// Every layer is rounded a few times (radiosity, its sum over rays, the pixel), by 2^-24 of its
// value, in the worst case in the same direction.
void expect_same_sum(const scenes::Scene& scene, std::size_t cells, bool lit_everywhere) {
  const Frame whole = drawn(scene, false);
  const Frame parts = drawn(tests::in_parts(scene, cells), true);
  const std::vector<float>& picture = whole.image.find("G")->values;
  std::vector<double> sum(picture.size(), 0.0);
  std::size_t layers = 0;
  for (const base::Channel& channel : parts.image.channels) {
    if (channel.name.rfind("light_", 0) != 0 || channel.name.back() != 'G') continue;
    ++layers;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += double(channel.values[i]);
  }
  if (layers == 0) {  // a single group has no layers
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] = double(parts.image.find("G")->values[i]);
    }
  }
  std::size_t lit = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    lit += picture[i] > 0.0F ? 1 : 0;
    EXPECT_NEAR(sum[i], double(picture[i]), 8.0 * 0x1p-24 * double(picture[i])) << i;
  }
  EXPECT_GT(lit, lit_everywhere ? sum.size() * 9 / 10 : sum.size() / 4);
}

TEST(SkyParts, LayersOfCellsAddUpToTheEarthsPicture) {
  scenes::Scene scene = things();
  scene.earth = tests::even_earth({-0.2, 0.5, 1.0}, 69.6, 100.0);
  expect_same_sum(scene, 48, true);
  expect_same_sum(scene, 2, true);
}

TEST(SkyParts, ThePartOfAPointSunIsTheSunsPicture) {
  // Without mirrors: sunlight by mirrors covers parts of patches, and the sample points of the two
  // sources differ.
  scenes::Scene scene = things();
  for (scenes::Material& material : scene.materials) material.mirror = Rgb(0.0);
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(1, -1, 2));
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 0.0;
  scene.sun = sun;
  expect_same_sum(scene, 2, false);
}

// The disc itself, seen by the camera and in the mirror: E / (pi sin^2 r) for the scene's Sun and
// for a part. Nothing else in the picture is as bright.
TEST(SkyParts, TheDiscOfASunIsSeen) {
  scenes::Scene scene = things();
  scenes::Sun sun;
  sun.direction = glm::normalize(Vec3(-1.0, 2.8, 1.8));
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 4.0;
  scene.sun = sun;
  const double radiance = 1000.0 / (base::pi * std::pow(std::sin(base::radians(4.0)), 2));
  const Frame whole = drawn(scene, false), part = drawn(tests::in_parts(scene, 2), false);
  const std::vector<float>&a = whole.image.find("G")->values, &b = part.image.find("G")->values;
  std::size_t disc = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (double(a[i]) < 0.5 * radiance) continue;
    ++disc;
    EXPECT_NEAR(double(b[i]), double(a[i]), 1e-5 * radiance);
  }
  EXPECT_GT(disc, 0U);
}

double mean_of(const Frame& frame, const std::string& channel) {
  const std::vector<float>& values = frame.image.find(channel)->values;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

constexpr std::size_t many_suns = 9;

scenes::SkyParts nine_suns() {
  scenes::SkyParts all;
  for (std::size_t k = 0; k < many_suns; ++k) {
    const double angle = base::radians(-60.0 + 15.0 * static_cast<double>(k));
    scenes::Sun sun;
    sun.direction = glm::normalize(Vec3(std::sin(angle), -0.4, std::cos(angle)));
    sun.illuminance_lx = Rgb(1000.0);
    all.suns.push_back(sun);
  }
  return all;
}

scenes::Scene under(scenes::SkyParts parts) {
  scenes::Scene scene = things();
  scene.sky_parts = std::make_shared<const scenes::SkyParts>(std::move(parts));
  return scene;
}

// Paths carry the many Suns by strata. The light of each Sun has the mean of a picture with this
// Sun alone: over pictures with different seeds, within four standard errors of their difference.
TEST(SkyParts, SunsThatTakeTurnsGiveWhatEachGivesAlone) {
  constexpr std::size_t count = many_suns;
  constexpr std::uint64_t seeds = 12;
  const scenes::SkyParts all = nine_suns();
  std::array<std::vector<double>, count> taking_turns;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Frame together = drawn(under(all), true, seed);
    for (std::size_t k = 0; k < count; ++k) {
      taking_turns[k].push_back(mean_of(together, fmt::format("light_sun-{}.G", k)));
    }
  }
  for (const std::size_t k : {std::size_t{0}, std::size_t{3}, std::size_t{8}}) {
    scenes::SkyParts one;
    one.suns = {all.suns[k]};
    double sum = 0.0, squares = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      // A single group has no layer.
      const double off =
          taking_turns[k][seed - 1] - mean_of(drawn(under(one), true, seed + seeds), "G");
      sum += off;
      squares += off * off;
    }
    const double mean = sum / double(seeds);
    const double error = std::sqrt((squares / double(seeds) - mean * mean) / double(seeds - 1));
    EXPECT_GT(taking_turns[k].front(), 1.0);
    EXPECT_LT(std::abs(mean), 4.0 * error) << "sun " << k;
    EXPECT_LT(error, 0.02 * taking_turns[k].front()) << "sun " << k;
  }
}

// Both halves of a point's paths cover all strata: they differ by chance only, and the stated error
// of one Sun equals the difference between seeds. A Sun in only one half would count as noise.
// Squares averaged over pairs of seeds; without denoising, which would remove its part of the
// noise.
TEST(SkyParts, NoiseStatedOfASunThatTakesTurnsIsWhatOtherSeedsDifferBy) {
  constexpr std::uint64_t pairs = 12;
  const scenes::Scene scene = under(nine_suns());
  const tests::Prepared prepared(scene);
  radiosity::SolveOptions solve;
  solve.patch_edge_m = 0.5;
  solve.form_factor_rays = 256;
  radiosity::Solution solution = prepared.solve(solve);
  // Leaves all interreflection to paths.
  for (auto* values : {&solution.radiosity, &solution.indirect_radiosity}) {
    for (float& value : *values) value = 0.0F;
  }
  RenderOptions options;
  options.columns = options.rows = 24;
  options.gather_rays = 16;  // and half as many paths, four in each half
  options.denoise = false;
  options.per_light = true;
  constexpr std::size_t sun = 4;
  const std::string channel = fmt::format("light_sun-{}.G", sun);
  std::vector<double> weights;
  for (const std::string& group : prepared.groups.names) {
    weights.push_back(group == fmt::format("sun-{}", sun) ? 1.0 : 0.0);
  }
  std::vector<double> off;
  double stated = 0.0;
  for (std::uint64_t k = 0; k < pairs; ++k) {
    options.seed = 2 * k + 1;
    const Frame one = render(prepared, solution, looking_up(), options);
    options.seed = 2 * k + 2;
    const Frame other = render(prepared, solution, looking_up(), options);
    const auto &a = one.image.find(channel)->values, &b = other.image.find(channel)->values;
    double mean = 0.0, squares = 0.0, counted = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) {
      if (!one.error.counts(p)) continue;
      mean += 0.5 * double(a[p] + b[p]), counted += 1.0;
    }
    mean /= counted;
    for (std::size_t p = 0; p < a.size(); ++p) {
      if (!one.error.counts(p)) continue;
      const double weight = error_weight(0.5 * double(a[p] + b[p]), mean);
      squares += 0.5 * std::pow(weight * double(a[p] - b[p]), 2);
    }
    const double expected = 0.5 * (std::pow(one.layers.of(weights)->relative(), 2) +
                                   std::pow(other.layers.of(weights)->relative(), 2));
    off.push_back(squares / counted / (mean * mean) - expected);
    stated += expected / double(pairs);
  }
  double sum = 0.0, squares = 0.0;
  for (const double x : off) sum += x, squares += x * x;
  const double mean = sum / double(pairs);
  const double error = std::sqrt((squares / double(pairs) - mean * mean) / double(pairs - 1));
  EXPECT_LT(std::abs(mean), 4.0 * error) << "stated " << stated;
  EXPECT_LT(error, 0.15 * stated);
}

}  // namespace
}  // namespace earthshine::raytrace
