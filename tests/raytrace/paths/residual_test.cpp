// SPDX-License-Identifier: Apache-2.0
// Residual paths: pictures have the right mean for any solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "base/numbers/random.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/render.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

constexpr int edge_px = 20, pictures = 32;

struct Means {
  double mean = 0.0, standard_error = 0.0;
};

// The scene is grey, so that green suffices: of the picture, and of both groups' layers.
constexpr std::array channels = {"G", "light_lamp.G", "light_panels.G"};

// The object at the centre of every pixel, from 0 on; every pixel has one.
const std::vector<float>& objects() {
  static const std::vector<float> seen = [] {
    RenderOptions options;
    options.columns = options.rows = edge_px;
    options.gather_rays = 1;
    options.aovs = {"object"};
    return tests::small_room().picture(options).image.find("object")->values;
  }();
  return seen;
}
constexpr std::size_t room_objects = 7;  // walls and the block, which is the last

// Per channel, for pictures with different seeds: the mean of all pixels, and of every visible
// object's pixels.
template <class Draw>
std::vector<Means> means_of(const Draw& draw) {
  std::array<double, 1 + room_objects> pixels{};
  for (const float object : objects()) {
    ++pixels[0];
    ++pixels[1 + static_cast<std::size_t>(object)];
  }
  std::vector<std::vector<double>> found;  // per picture
  for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
    const base::Image image = draw(tests::small_room(), seed);
    std::vector<double> means;
    for (const char* const channel : channels) {
      std::array<double, 1 + room_objects> sums{};
      const std::vector<float>& light = image.find(channel)->values;
      for (std::size_t p = 0; p < light.size(); ++p) {
        sums[0] += double(light[p]);
        sums[1 + static_cast<std::size_t>(objects()[p])] += double(light[p]);
      }
      for (std::size_t k = 0; k < sums.size(); ++k) {
        if (pixels[k] > 0.0) means.push_back(sums[k] / pixels[k]);
      }
    }
    found.push_back(means);
  }
  std::vector<Means> means(found.front().size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    double squares = 0.0;
    for (const auto& one : found) means[k].mean += one[k] / pictures;
    for (const auto& one : found) squares += std::pow(one[k] - means[k].mean, 2);
    means[k].standard_error = std::sqrt(squares / (pictures - 1.0) / pictures);
  }
  return means;
}

std::vector<Means> pictures_of(const radiosity::Solution& solution, bool denoise) {
  return means_of([&](const tests::SmallRoom& room, std::uint64_t seed) {
    RenderOptions options;
    options.columns = options.rows = edge_px;
    options.gather_rays = 64;
    options.denoise = denoise;
    options.per_light = true;
    options.seed = seed;
    return render(room.prepared, solution, room.camera, options).image;
  });
}

const std::vector<Means>& truth() {
  static const std::vector<Means> found =
      means_of([](const tests::SmallRoom& room, std::uint64_t seed) {
        PathOptions options;
        options.columns = options.rows = edge_px;
        options.paths_per_pixel = 256;
        options.paths = PathSet::NoCaustics;
        options.per_light = true;
        options.seed = seed;
        return trace_paths(room.prepared, room.camera, options).image;
      });
  return found;
}

void expect_truth(const radiosity::Solution& solution, const char* what) {
  ASSERT_GE(std::set<float>(objects().begin(), objects().end()).size(), 4U);
  ASSERT_GE(std::ranges::count(objects(), float(room_objects - 1)), 10);
  for (const bool denoise : {true, false}) {
    const std::vector<Means> found = pictures_of(solution, denoise);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Means &a = found[k], &b = truth()[k];
      EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.standard_error, b.standard_error))
          << what << ", denoising " << denoise << ", part " << k;
      EXPECT_LT(std::hypot(a.standard_error, b.standard_error), 0.03 * b.mean) << what;
    }
  }
}

radiosity::Solution scaled(double factor) {
  radiosity::Solution solution = tests::small_room().solution;
  for (auto* values : {&solution.radiosity, &solution.indirect_radiosity}) {
    for (float& value : *values) value *= static_cast<float>(factor);
  }
  return solution;
}

TEST(Residual, TheSolutionAsItIsGivesTheTruth) { expect_truth(scaled(1.0), "as it is"); }

TEST(Residual, ASolutionOfZerosGivesTheTruth) { expect_truth(scaled(0.0), "zeros"); }

TEST(Residual, TwiceTheSolutionGivesTheTruth) { expect_truth(scaled(2.0), "twice"); }

TEST(Residual, NoiseInPlaceOfASolutionGivesTheTruth) {
  radiosity::Solution solution = scaled(1.0);
  base::Rng rng(base::Key(1, base::Stream::Test, 9));
  for (auto* values : {&solution.radiosity, &solution.indirect_radiosity}) {
    double mean = 0.0;
    for (const float value : *values) mean += double(value) / static_cast<double>(values->size());
    for (float& value : *values) value = static_cast<float>(2.0 * mean * rng.next());
  }
  expect_truth(solution, "noise");
}

TEST(Residual, OnePatchAFaceGivesTheTruth) {
  radiosity::SolveOptions coarse;
  coarse.patch_edge_m = 10.0;
  coarse.form_factor_rays = 16;
  expect_truth(tests::small_room().prepared.solve(coarse), "one patch a face");
}

TEST(Residual, AHundredThousandPatchesGiveTheTruth) {
  radiosity::SolveOptions fine;
  fine.patch_edge_m = 0.008;
  fine.form_factor_rays = 16;
  const radiosity::Solution solution = tests::small_room().prepared.solve(fine);
  EXPECT_GT(solution.patches.count(), 90'000U);
  expect_truth(solution, "100 000 patches");
}

TEST(Residual, EachGroupOfLightHasItsTruthWhereOneIsWrong) {
  // Twice the lamp's light and none of the wall's; then the reverse.
  for (const std::size_t twice : {std::size_t{0}, std::size_t{1}}) {
    radiosity::Solution solution = scaled(1.0);
    ASSERT_EQ(solution.columns, 6U);
    for (auto* values : {&solution.radiosity, &solution.indirect_radiosity}) {
      for (std::size_t k = 0; k < values->size(); ++k) {
        (*values)[k] *= k % 6 / 3 == twice ? 2.0F : 0.0F;
      }
    }
    expect_truth(solution, twice == 0 ? "the first alone, twice" : "the second alone, twice");
  }
}

// A room whose walls emit 1 - rho and reflect rho: B = 1 everywhere.
struct Furnace {
  explicit Furnace(double reflectance) {
    const std::uint32_t wall = builder.material(tests::grey(reflectance, 1.0 - reflectance));
    builder.room({wall, wall, wall, wall, wall, wall});
    prepared.emplace(builder.scene);
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 0.25;
    solve.form_factor_rays = 64;
    solution = prepared->solve(solve);
    camera.position = Vec3(0.3, 0.4, 0.5);
    camera.look_at = Vec3(1, 0.6, 0.3);
  }
  [[nodiscard]] Frame picture(std::uint64_t seed) const {
    RenderOptions options;
    options.columns = options.rows = 8;
    options.gather_rays = 16;
    options.seed = seed;
    return render(*prepared, solution, camera, options);
  }

  tests::SceneBuilder builder;
  std::optional<tests::Prepared> prepared;
  radiosity::Solution solution;
  scenes::Camera camera;
};

TEST(Residual, OfAFurnaceIsZeroOnEverySample) {
  // Every term S + T L~ - L~ is (1 - rho) + rho - 1 over pi, so that pictures are exact without
  // noise; and paths end for any reflectance.
  for (const double reflectance : {0.6, 0.9999999}) {
    const Frame frame = Furnace(reflectance).picture(1);
    for (const float v : frame.image.find("G")->values) {
      EXPECT_NEAR(double(v), 1.0 / base::pi, 1e-6) << reflectance;
    }
    EXPECT_LT(frame.report.relative_noise, 1e-6) << reflectance;
  }
}

TEST(Residual, LongWalksThatEndEarlyLoseNothing) {
  // Of the light in a furnace of 0.99, 0.99^128 = 28 % has more than 128 reflections, from where on
  // paths end at doublings; a solution of zeros leaves all of it to them.
  Furnace furnace(0.99);
  for (auto* values : {&furnace.solution.radiosity, &furnace.solution.indirect_radiosity}) {
    std::ranges::fill(*values, 0.0F);
  }
  std::vector<double> means;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Frame frame = furnace.picture(seed);
    const std::vector<float>& light = frame.image.find("G")->values;
    means.push_back(std::accumulate(light.begin(), light.end(), 0.0) / double(light.size()));
  }
  const auto count = static_cast<double>(means.size());
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / count;
  double squares = 0.0;
  for (const double one : means) squares += (one - mean) * (one - mean);
  const double standard_error = std::sqrt(squares / (count - 1.0) / count);
  EXPECT_NEAR(mean, 1.0 / base::pi, 4.0 * standard_error);
  EXPECT_LT(standard_error, 0.02 / base::pi);  // lost light would be ten times as much
}

}  // namespace
}  // namespace earthshine::raytrace
