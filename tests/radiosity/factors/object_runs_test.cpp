// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/exact/polygon/polygon_factor.h"
#include "radiosity/factors/patch_rays.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

constexpr int run_rays = 64;

// Adjacent squares with these sides in the plane z = 0.
scenes::Scene plates(const std::vector<double>& sides) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  double x = 0.0;
  for (const double a : sides) {
    builder.quad(m, {x, 0, 0}, {x + a, 0, 0}, {x + a, a, 0}, {x, a, 0});
    x += a;
  }
  return builder.scene;
}

FormFactors cast(const scenes::Scene& scene, const Patches& patches, int each, bool know_objects) {
  const scenes::RayQuery query(scene);
  FormFactorOptions options;
  options.rays_per_patch = each;
  options.know_objects = know_objects;
  return cast_form_factors(scene, query, patches, options);
}

TEST(ObjectRuns, EveryObjectIsKnownByTheRaysOf64Patches) {
  // Divided at 1 m: 1, 4, 36, 64 and 100 patches. 64 / 36 is rounded up to a power of two.
  const scenes::Scene scene = plates({1, 2, 6, 8, 10});
  EXPECT_EQ(object_runs(scene, subdivide(scene, 1.0), run_rays),
            (std::vector<std::uint32_t>{64, 16, 2, 1, 1}));
}

TEST(ObjectRuns, NoRowIsLongerThanAMillionRaysForIt) {
  const scenes::Scene scene = plates({1});
  const Patches patches = subdivide(scene, 1.0);
  EXPECT_EQ(object_runs(scene, patches, 1 << 16)[0], 16U);
  EXPECT_EQ(object_runs(scene, patches, 1 << 20)[0], 1U);
  EXPECT_EQ(object_runs(scene, patches, 1 << 24)[0], 1U);
}

TEST(ObjectRuns, ManySmallObjectsShareABoundedCost) {
  // n objects of one patch each would add 63 n runs: up to 2048 are allowed, or a quarter of all
  // patches if that is more. 32 objects add 2016. 33 get half as many each. For 10 000, a quarter
  // adds less than one run to each.
  for (const auto& [objects, wanted] : std::vector<std::pair<std::size_t, std::uint32_t>>{
           {32, 64}, {33, 32}, {2048, 2}, {10000, 1}}) {
    const scenes::Scene scene = plates(std::vector<double>(objects, 1.0));
    const std::vector<std::uint32_t> runs = object_runs(scene, subdivide(scene, 1.0), run_rays);
    for (const std::uint32_t of_object : runs) EXPECT_EQ(of_object, wanted) << objects;
  }
}

// A room of 6 x 16 patches, each wall an object, and an instrument of one patch in its middle.
scenes::Scene room_with_gauge() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  builder.quad(m, {.5, .5, .5}, {.52, .5, .5}, {.52, .52, .5}, {.5, .52, .5});
  return builder.scene;
}

TEST(ObjectRuns, ARowOfManyRunsIsTheRowOfAsManyRaysAPatch) {
  // Runs continue the sequence: 64 runs are its first 64 * 64 points, with exactly equal hits.
  const scenes::Scene scene = room_with_gauge();
  const Patches patches = subdivide(scene, 0.25);
  const FormFactors runs = cast(scene, patches, run_rays, true);
  const FormFactors alone = cast(scene, patches, 64 * run_rays, false);
  const std::size_t gauge = patches.count() - 1;
  const auto row = [gauge](const FormFactors& f) {
    return std::vector<float>(f.hits.begin() + std::ptrdiff_t(f.row_start[gauge]),
                              f.hits.begin() + std::ptrdiff_t(f.row_start[gauge + 1]));
  };
  EXPECT_EQ(row(runs), row(alone));
  EXPECT_EQ(runs.row_scale[gauge], alone.row_scale[gauge]);
  // Walls of 16 patches cast 4 runs.
  EXPECT_EQ(runs.ray_count, std::uint64_t{run_rays} * (6 * 16 * 4 + 64));
  EXPECT_EQ(runs.rays_per_patch, run_rays);
}

TEST(ObjectRuns, RowsOfUnlikeNumbersOfRaysCloseAndBalance) {
  const scenes::Scene scene = room_with_gauge();
  const Patches patches = subdivide(scene, 0.2);
  FormFactors f = cast(scene, patches, run_rays, true);
  for (std::size_t i = 0; i < f.count(); ++i) {
    const double landed = std::accumulate(f.hits.begin() + std::ptrdiff_t(f.row_start[i]),
                                          f.hits.begin() + std::ptrdiff_t(f.row_start[i + 1]), 0.0);
    EXPECT_NEAR(f.row_scale[i] * landed + f.sky[i] + f.black[i], 1.0, 1e-15);
  }
  EXPECT_TRUE(balance(f, patches.area_m2).balanced);
}

TEST(ObjectRuns, SameBytesOnOneAndTwoThreads) {
  const scenes::Scene scene = room_with_gauge();
  const Patches patches = subdivide(scene, 0.25);
  FormFactors one, two;
  {
    const base::ThreadLimit limit(1);
    one = cast(scene, patches, run_rays, true);
  }
  {
    const base::ThreadLimit limit(2);
    two = cast(scene, patches, run_rays, true);
  }
  EXPECT_EQ(one.column, two.column);
  EXPECT_EQ(one.hits, two.hits);
  EXPECT_EQ(one.row_scale, two.row_scale);
}

TEST(ObjectRuns, AGaugeIsAsWellKnownAsAWall) {
  // 16 instruments of one patch under an emitting plate of 4 x 4 m at 2 m: F of each in closed
  // form, about 0.3. 1024 rays per patch: 64 runs have an error of F of (F (1 - F) / 65536)^1/2 =
  // 0.0018 for independent rays, at most a third of it for stratified ones; one run alone has three
  // times this error.
  constexpr int a_patch = 1024;
  constexpr double half = 0.01, height = 2.0;
  tests::SceneBuilder builder;
  const std::uint32_t black = builder.material(tests::grey(0.0));
  std::vector<double> exact;
  const Vec3 up{0, 0, 1};
  const ConvexPolygon plate =
      make_polygon({{{-2, -2, height}, {-2, 2, height}, {2, 2, height}, {2, -2, height}}}, -up);
  for (int k = 0; k < 16; ++k) {
    const Vec3 c(-1.5 + k % 4, -1.2 + 0.8 * (k / 4), 0.0);
    const std::array<Vec3, 4> at = {c + Vec3(-half, -half, 0), c + Vec3(half, -half, 0),
                                    c + Vec3(half, half, 0), c + Vec3(-half, half, 0)};
    builder.quad(black, at[0], at[1], at[2], at[3]);
    exact.push_back(exchange_m2(make_polygon(at, up), plate) / (4.0 * half * half));
  }
  builder.plate(builder.material(tests::grey(0.0, 1.0)), 4.0, height, false);
  SolveOptions options;
  options.patch_edge_m = 0.5;
  options.form_factor_rays = a_patch;
  const Solution solution = tests::Prepared(builder.scene).solve(options);
  double square = 0.0, independent = 0.0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double error = solution.report.objects[k].illuminance_lx.g - exact[k];
    square += error * error / double(exact.size());
    independent += exact[k] * (1.0 - exact[k]) / (64.0 * a_patch) / double(exact.size());
  }
  EXPECT_LE(std::sqrt(square), std::sqrt(independent) / 3.0);
}

}  // namespace
}  // namespace earthshine::radiosity
