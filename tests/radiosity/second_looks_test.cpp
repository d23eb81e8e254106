// SPDX-License-Identifier: Apache-2.0
#include "radiosity/second_looks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/split.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

// A grey room with a bright wall and a disk lamp, of which a shelf hides some.
scenes::Scene lit_room() {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  builder.room({builder.material(tests::grey(0.5, 50.0)), grey, grey, grey, grey, grey});
  builder.quad(grey, {0.3, 0.3, 0.5}, {0.7, 0.3, 0.5}, {0.7, 0.7, 0.5}, {0.3, 0.7, 0.5});
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.kind = scenes::LampKind::Disk;
  lamp.position = {0.5, 0.5, 0.95};
  lamp.axis = {0, 0, -1};
  lamp.radius_m = 0.2;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  return builder.scene;
}

SolveOptions even(double edge_m, int rays, std::uint64_t seed = 1) {
  SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = rays;
  options.seed = seed;
  return options;
}

// Green radiosity, all groups together, per patch.
std::vector<double> radiosity_of(const Solution& solution) {
  std::vector<double> values(solution.patches.count(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 1; k < solution.columns; k += 3) {
      values[i] += double(solution.radiosity[i * solution.columns + k]);
    }
  }
  return values;
}

struct All {
  SecondLooks made;
  std::vector<Solution> few, direct, other;
};

All look(const tests::Prepared& prepared, const SolveOptions& options, const Solution& solution) {
  All all;
  all.made = look_again(prepared.scene, prepared.groups, prepared.effects, prepared.query, options,
                        solution, [&](Look kind, const Solution& seen) {
                          (kind == Look::FewRays       ? all.few
                           : kind == Look::OtherDirect ? all.direct
                                                       : all.other)
                              .push_back(seen);
                        });
  return all;
}

TEST(SecondLooks, AreIndependentOfEachOtherAndUnbiased) {
  constexpr int seeds = 60;
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  const std::vector<double> truth = radiosity_of(prepared.solve(even(0.5, 1 << 15)));
  const std::size_t count = truth.size();
  std::vector<std::vector<std::vector<double>>> looks;  // seed, look, patch
  std::vector<std::vector<double>> own;
  for (int seed = 0; seed < seeds; ++seed) {
    const SolveOptions options = even(0.5, 512, 100 + static_cast<std::uint64_t>(seed));
    const Solution solution = prepared.solve(options);
    own.push_back(radiosity_of(solution));
    const All all = look(prepared, options, solution);
    ASSERT_EQ(all.few.size(), few_rays_looks);
    looks.emplace_back();
    for (const Solution& few : all.few) looks.back().push_back(radiosity_of(few));
  }
  std::vector<double> mean(count, 0.0), mean_own(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (int s = 0; s < seeds; ++s) {
      mean_own[i] += own[s][i] / seeds;
      for (const auto& one : looks[s]) mean[i] += one[i] / (seeds * double(few_rays_looks));
    }
  }
  // Covariance of two looks of one seed, and of a look and the solution, mean over the patches: of
  // each seed one value, whose own spread tells the standard error.
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& mean_a,
                           const std::vector<double>& b, const std::vector<double>& mean_b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += (a[i] - mean_a[i]) * (b[i] - mean_b[i]);
    return sum / double(count);
  };
  const auto expect_none = [&](auto of_seed) {
    double sum = 0.0, squares = 0.0;
    for (int s = 0; s < seeds; ++s) {
      const double value = of_seed(s);
      sum += value;
      squares += value * value;
    }
    EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(squares));
  };
  expect_none([&](int s) {
    double sum = 0.0;
    for (std::size_t k = 0; k < few_rays_looks; ++k) {
      for (std::size_t l = 0; l < k; ++l) sum += product(looks[s][k], mean, looks[s][l], mean);
    }
    return sum;
  });
  expect_none([&](int s) {
    double sum = 0.0;
    for (const auto& one : looks[s]) sum += product(one, mean, own[s], mean_own);
    return sum;
  });
  // Unbiased: the mean over all looks of the mean radiosity against many rays. Sixteen rays per
  // patch make the solve slightly nonlinear in its noise: a twentieth of one look's error is let
  // pass beside chance.
  std::vector<double> averages;
  for (const auto& of_seed : looks) {
    for (const auto& one : of_seed) {
      averages.push_back(std::accumulate(one.begin(), one.end(), 0.0) / double(count));
    }
  }
  const double exact = std::accumulate(truth.begin(), truth.end(), 0.0) / double(count);
  double all = 0.0, squares = 0.0;
  for (const double average : averages) {
    all += average / double(averages.size());
    squares += std::pow(average - exact, 2.0) / double(averages.size());
  }
  const double one_look = std::sqrt(squares);
  EXPECT_NEAR(all, exact, 4.0 * one_look / std::sqrt(double(averages.size())) + 0.05 * one_look);
}

TEST(SecondLooks, SpreadAsTheSharesSay) {
  // With 512 rays the few-ray looks have 16, a 32nd; with 128 no fewer than 16, an eighth.
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  for (const auto& [rays, share] : {std::pair{512, 1.0 / 32.0}, {128, 0.125}, {8, 1.0}}) {
    const SolveOptions options = even(0.5, rays);
    const Solution solution = prepared.solve(options);
    const All all = look(prepared, options, solution);
    EXPECT_EQ(all.made.ray_share, share);
    EXPECT_EQ(all.made.point_share, 0.25);
    EXPECT_NEAR(
        double(all.few[0].report.form_factor_rays) / double(solution.report.form_factor_rays),
        share, 0.02 * share);
  }
}

TEST(SecondLooks, OtherDirectLightIsTheSolutionsOnAverage) {
  // The looks' mean direct light is taken off: what is added adds up to nothing.
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  const SolveOptions options = even(0.5, 64);
  const Solution solution = prepared.solve(options);
  const All all = look(prepared, options, solution);
  ASSERT_EQ(all.direct.size(), few_rays_looks);
  const std::vector<double> own = radiosity_of(solution);
  std::vector<double> mean(own.size(), 0.0);
  double apart = 0.0;
  for (const Solution& other : all.direct) {
    const std::vector<double> values = radiosity_of(other);
    for (std::size_t i = 0; i < own.size(); ++i) {
      mean[i] += values[i] / few_rays_looks;
      apart = std::max(apart, std::abs(values[i] - own[i]));
    }
  }
  // Sixteen points in place of sixty-four, in penumbras: far more than rounding.
  EXPECT_GT(apart, 1e-3 * *std::max_element(own.begin(), own.end()));
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(mean[i], own[i], 1e-5 * own[i] + 1e-9);
}

TEST(SecondLooks, OtherDirectLightIsTheSolutionWhereNothingIsSampled) {
  // A closed room of emitting walls: all light comes through form factors.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5, 10.0));
  builder.room({m, m, m, m, m, m});
  const tests::Prepared prepared(builder.scene);
  const SolveOptions options = even(0.5, 64);
  const Solution solution = prepared.solve(options);
  for (const Solution& other : look(prepared, options, solution).direct) {
    EXPECT_EQ(radiosity_of(other), radiosity_of(solution));
  }
}

std::vector<double> area_of_facets(const Patches& patches) {
  std::vector<double> area(patches.facets.size(), 0.0);
  for (std::size_t i = 0; i < patches.count(); ++i) area[patches.facet[i]] += patches.area_m2[i];
  return area;
}

TEST(SecondLooks, EvenPatchesAreJudgedByTwiceTheirEdge) {
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  const SolveOptions options = even(0.125, 64);
  const Solution solution = prepared.solve(options);
  const All all = look(prepared, options, solution);
  EXPECT_FALSE(all.made.finer);
  EXPECT_EQ(all.made.other_patches, count_patches(scene, 0.25));
  // 6 faces of 8 x 8 and a shelf of 4 x 4, into 6 of 4 x 4 and one of 2 x 2.
  EXPECT_EQ(solution.patches.count(), 400U);
  EXPECT_EQ(all.made.other_patches, 100U);
  EXPECT_DOUBLE_EQ(all.made.error_ratio, 0.5);
  ASSERT_EQ(all.other.size(), other_patches_looks);
  for (const Solution& other : all.other) EXPECT_EQ(other.patches.count(), 100U);
  EXPECT_NE(radiosity_of(all.other[0]), radiosity_of(all.other[1]));
}

TEST(SecondLooks, PatchesThatCannotBeCoarserAreJudgedByQuarters) {
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  const SolveOptions options = even(5.0, 64);  // each face is one patch, whatever the edge
  const Solution solution = prepared.solve(options);
  const All all = look(prepared, options, solution);
  EXPECT_TRUE(all.made.finer);
  EXPECT_EQ(all.made.error_ratio, 0.5);
  EXPECT_EQ(all.made.other_patches, 4 * solution.patches.count());
  const Patches& finer = all.other.front().patches;
  EXPECT_EQ(finer.count(), all.made.other_patches);
  const std::vector<double> before = area_of_facets(solution.patches),
                            after = area_of_facets(finer);
  for (std::size_t f = 0; f < before.size(); ++f) EXPECT_NEAR(after[f], before[f], 1e-12);
  for (std::size_t i = 0; i < finer.count(); ++i) {
    EXPECT_NEAR(finer.area_m2[i], before[finer.facet[i]] / 4.0, 1e-12);
    // Halved both ways: every cell here is a square.
    const CellSize size = cell_size(finer, static_cast<std::uint32_t>(i));
    EXPECT_NEAR(size.s_m, size.t_m, 1e-12);
  }
}

TEST(SecondLooks, RefinedPatchesAreJudgedByQuartersOfEachOfThem) {
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  SolveOptions options = even(0.05, 64);
  options.refine = {true, 0.5, 400, 0.0};
  const Solution solution = prepared.solve(options);
  ASSERT_GT(solution.report.rounds.size(), 1U);
  const All all = look(prepared, options, solution);
  EXPECT_TRUE(all.made.finer);
  EXPECT_EQ(all.made.error_ratio, 0.5);
  EXPECT_EQ(all.other.front().patches.count(), 4 * solution.patches.count());
}

TEST(SecondLooks, CountTheirRaysAndLeaveTheSolutionAlone) {
  const scenes::Scene scene = lit_room();
  const tests::Prepared prepared(scene);
  const SolveOptions options = even(0.5, 64);
  const Solution solution = prepared.solve(options);
  const Solution before = solution;
  const All all = look(prepared, options, solution);
  EXPECT_EQ(solution.radiosity, before.radiosity);
  std::uint64_t rays = 0;
  for (const auto* kind : {&all.few, &all.other}) {
    for (const Solution& other : *kind) {
      rays += other.report.form_factor_rays + other.report.shadow_rays;
    }
  }
  EXPECT_EQ(all.made.rays, rays);
}

}  // namespace
}  // namespace earthshine::radiosity
