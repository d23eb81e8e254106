// SPDX-License-Identifier: Apache-2.0
#include "studies/surface_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/radiance_table.h"
#include "tests/studies/plates.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

// Luminance of the radiosity as pictures read it, where a ray down from a little above meets the
// plate.
double value_at(const tests::Prepared& prepared, const raytrace::RadianceTable& table, double x,
                double y) {
  const scenes::Hit hit = prepared.query.closest({x, y, 0.1}, {0, 0, -1});
  std::array<Rgb, 1> sum{Rgb(0.0)};
  table.add(hit, Rgb(base::pi), sum);
  return base::luminance(sum[0]);
}

// Root mean square over a plate of 1 m x 1 m about the origin of what the radiosity, interpolated,
// is off from the true one, relative to its mean.
template <class Truth>
double true_error(const tests::Prepared& prepared, const radiosity::Solution& solution,
                  const Truth& truth) {
  const raytrace::RadianceTable table(solution, solution.radiosity, false);
  constexpr int n = 200;
  double off = 0.0, all = 0.0;
  for (int k = 0; k < n * n; ++k) {
    const double x = (k / n + 0.5) / n - 0.5, y = (k % n + 0.5) / n - 0.5;
    const double b = value_at(prepared, table, x, y);
    off += std::pow(b - truth(x, y), 2.0) / (n * n);
    all += b / (n * n);
  }
  return std::sqrt(off) / all;
}

radiosity::SolveOptions even(double edge_m) {
  radiosity::SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = 256;
  return options;
}

SurfaceError error_of(const tests::Prepared& prepared, const radiosity::Solution& solution,
                      const radiosity::SolveOptions& options) {
  return surface_error({prepared.scene, prepared.groups, prepared.effects, prepared.query},
                       solution, options);
}

// A plate of 1 m under a point lamp of 100 cd at 0.6 m: B = rho I h / d^3.
struct LitPlate {
  scenes::Scene scene;
  static constexpr double height_m = 0.6;
  explicit LitPlate(bool sheet_from_behind = false) {
    tests::SceneBuilder builder;
    scenes::Material material = tests::grey(0.5);
    material.two_sided = sheet_from_behind;
    builder.plate(builder.material(material), 1.0, 0.0, !sheet_from_behind);
    scenes::Lamp lamp;
    lamp.name = lamp.group = "lamp";
    lamp.position = Vec3(0, 0, height_m);
    lamp.intensity_cd = Rgb(100.0);
    builder.scene.lamps.push_back(lamp);
    scene = builder.scene;
  }
  static double truth(double x, double y) {
    return 50.0 * height_m / std::pow(x * x + y * y + height_m * height_m, 1.5);
  }
};

TEST(SurfaceError, OfASmoothGradientIsThePatchesOwn) {
  const LitPlate plate;
  const tests::Prepared prepared(plate.scene);
  // 1 m is cut finer to be judged, for want of coarser patches; the others coarser. At 0.5 m the
  // cut of 1 m has one patch, which the lamp's symmetry leaves no slope: the first order is not
  // reached there, and between 1 m and 0.5 m.
  for (const double edge_m : {0.25, 0.125}) {
    const radiosity::Solution solution = prepared.solve(even(edge_m));
    const SurfaceError error = error_of(prepared, solution, even(edge_m));
    const double truth = true_error(prepared, solution, LitPlate::truth);
    ASSERT_TRUE(error.known);
    // Inside it falls with the square of the edge, as the estimate takes it; in the outer halves of
    // the cells at the border, where nothing is interpolated, with the edge itself, as the bound
    // does.
    EXPECT_LT(error.parts.patches.estimate, truth) << edge_m;
    EXPECT_GT(error.parts.patches.estimate, 0.5 * truth) << edge_m;
    EXPECT_GE(error.parts.patches.bound_95, truth) << edge_m;
    EXPECT_LT(error.parts.patches.bound_95, 3.0 * truth) << edge_m;
    // Nothing is reflected to anything; what is left is chance of the lamp's light.
    EXPECT_LT(error.parts.form_factors.estimate, 0.03 * truth);
  }
}

TEST(SurfaceError, CountsBothSidesOfASheet) {
  // A sheet that is lit from behind alone: with its dark side the mean square error halves, and so
  // does the mean: the error is sqrt(2) times that of the plate. Where points fall differs.
  const LitPlate plate, sheet(true);
  const tests::Prepared one(plate.scene), two(sheet.scene);
  const double error = error_of(one, one.solve(even(0.125)), even(0.125)).parts.patches.estimate;
  const SurfaceError behind = error_of(two, two.solve(even(0.125)), even(0.125));
  ASSERT_TRUE(behind.known);
  EXPECT_NEAR(behind.parts.patches.estimate / (std::sqrt(2.0) * error), 1.0, 0.05);
}

TEST(SurfaceError, IsMadeOutByAFinerCutWhereThereIsNoCoarser) {
  const LitPlate plate;
  const tests::Prepared prepared(plate.scene);
  const radiosity::Solution solution = prepared.solve(even(1.0));
  ASSERT_EQ(solution.patches.count(), 1U);
  const SurfaceError error = error_of(prepared, solution, even(1.0));
  EXPECT_GE(error.parts.patches.bound_95, 0.0);
  EXPECT_TRUE(error.known);
}

TEST(SurfaceError, OfAHardShadowLiesWithinItsBound) {
  // The Sun over half of the plate, with the shadow's edge askew: the error falls with the root of
  // the edge, and an estimate that takes the first order has 0.58 of it. That law holds on average
  // over places of the edge; the bound, which takes it, may be a tenth off for one of them.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.quad(builder.material(tests::grey(0.0)), {-2, -2, 0.5}, {0.83, -2, 0.5}, {-0.51, 2, 0.5},
               {-3.34, 2, 0.5});
  builder.scene.sun = tests::overhead_sun(1000.0);
  const tests::Prepared prepared(builder.scene);
  const auto truth = [](double x, double y) {
    return x > 0.83 - 1.34 * (y + 2.0) / 4.0 ? 500.0 : 0.0;
  };
  for (const double edge_m : {0.125, 0.0625}) {
    const radiosity::Solution solution = prepared.solve(even(edge_m));
    const SurfaceError error = error_of(prepared, solution, even(edge_m));
    const double off = true_error(prepared, solution, truth);
    EXPECT_GE(error.parts.total().bound_95, 0.9 * off) << edge_m;
    EXPECT_LT(error.parts.total().bound_95, 3.0 * off) << edge_m;
    EXPECT_GT(error.parts.patches.estimate, 0.3 * off) << edge_m;
  }
}

TEST(SurfaceError, OfARoomLiesWithinItsBound) {
  // Against a solution with 16 times the patches and 8 times the rays per patch.
  const tests::SmallRoom& room = tests::small_room();
  const SurfaceError error = surface_error(room.study(), room.solution, room.solver);
  radiosity::SolveOptions better = room.solver;
  better.patch_edge_m /= 4.0;
  better.form_factor_rays *= 8;
  better.seed = 2;
  const radiosity::Solution reference = room.prepared.solve(better);
  double off = 0.0, all = 0.0;
  for (std::uint32_t fine = 0; fine < reference.patches.count(); ++fine) {
    const radiosity::Rectangle cell = reference.patches.rectangle(fine);
    const radiosity::Facet& facet = room.solution.patches.facets[reference.patches.facet[fine]];
    const std::uint32_t own =
        facet.first_front +
        room.solution.patches.leaf(facet, {(cell.s0 + cell.s1) / 2, (cell.t0 + cell.t1) / 2});
    const auto sum = [](const radiosity::Solution& of, std::size_t patch) {
      double groups = 0.0;
      for (std::size_t k = 1; k < of.columns; k += 3) {
        groups += double(of.radiosity[patch * of.columns + k]);
      }
      return groups;
    };
    off += reference.patches.area_m2[fine] *
           std::pow(sum(room.solution, own) - sum(reference, fine), 2.0);
    all += reference.patches.area_m2[fine] * std::pow(sum(room.solution, own), 2.0);
  }
  const double truth = std::sqrt(off / all);
  EXPECT_LE(truth, error.parts.total().bound_95);
  EXPECT_LT(error.parts.total().bound_95, 4.0 * truth);
  EXPECT_GT(error.parts.form_factors.estimate, 0.0);
  EXPECT_GT(error.parts.lamps.estimate, 0.0);
  EXPECT_GT(error.rays, 0U);
}

TEST(SurfaceError, OfADarkSceneIsUnknown) {
  tests::SceneBuilder builder = tests::plate_on_ground(0.4, 0.6);
  const tests::Prepared prepared(builder.scene);
  const radiosity::Solution solution = prepared.solve(even(0.5));
  const SurfaceError error = error_of(prepared, solution, even(0.5));
  EXPECT_FALSE(error.known);
  EXPECT_EQ(error.rays, 0U);
  EXPECT_EQ(error.parts.total().bound_95, 0.0);
}

TEST(SurfaceError, SameOnOneAndTwoThreads) {
  const LitPlate plate;
  const tests::Prepared prepared(plate.scene);
  std::vector<SurfaceError> errors;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    errors.push_back(error_of(prepared, prepared.solve(even(0.25)), even(0.25)));
  }
  EXPECT_EQ(errors[0].parts.total().estimate, errors[1].parts.total().estimate);
  EXPECT_EQ(errors[0].parts.total().bound_95, errors[1].parts.total().bound_95);
}

}  // namespace
}  // namespace earthshine::studies
