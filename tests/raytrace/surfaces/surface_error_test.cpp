// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/surface_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/parallel.h"
#include "raytrace/error_budget.h"
#include "raytrace/incoming/radiance_table.h"
#include "tests/studies/plates.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

// Interpolated radiosity at a point of the surfaces; green, because the scenes are grey.
class Reader {
 public:
  explicit Reader(const radiosity::Solution& solution)
      : table_(solution, solution.radiosity, false, nothing_stands_there_) {}
  double operator()(const scenes::Hit& hit) const {
    std::array<Rgb, 1> radiance{Rgb(0.0)};
    table_.add(hit, Rgb(base::pi), radiance);
    return radiance[0].g;
  }

 private:
  LeakMask nothing_stands_there_;
  RadianceTable table_;
};

// RMS error of the solution at points of all fronts, weighted and relative to the mean as in
// SurfaceError.
template <class Truth>
double true_error(const scenes::Scene& scene, const radiosity::Solution& solution,
                  const Truth& truth) {
  constexpr int n = 200;
  const Reader own(solution);
  double off = 0.0, mean = 0.0, area = 0.0;
  const auto at_all_points = [&](auto&& call) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const double each = scenes::triangle_area(scene, t) * 2.0 / (n * (n + 1.0));
      for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
          scenes::Hit hit;
          hit.triangle = t;
          hit.u = (i + 1.0 / 3.0) / n;
          hit.v = (j + 1.0 / 3.0) / n;
          call(hit, each);
        }
      }
    }
  };
  at_all_points([&](const scenes::Hit& hit, double part) {
    mean += part * truth(hit);
    area += part;
  });
  mean /= area;
  at_all_points([&](const scenes::Hit& hit, double part) {
    const double right = truth(hit), weight = error_weight(right, mean);
    off += part * std::pow(weight * (own(hit) - right), 2.0);
  });
  return std::sqrt(off / area) / mean;
}

Vec3 point_of(const scenes::Scene& scene, const scenes::Hit& hit) {
  const auto& corner = scene.triangles[hit.triangle].vertex;
  const Vec3 &a = scene.vertices[corner[0]], &b = scene.vertices[corner[1]],
             &c = scene.vertices[corner[2]];
  return a + hit.u * (b - a) + hit.v * (c - a);
}

radiosity::SolveOptions even(double edge_m) {
  radiosity::SolveOptions options;
  options.patch_edge_m = edge_m;
  options.form_factor_rays = 256;
  return options;
}

SurfaceError error_of(const tests::Prepared& prepared, const radiosity::Solution& solution,
                      const radiosity::SolveOptions& options) {
  return surface_error(prepared, solution, options);
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
  // Interpolated radiosity is of second order within the plate and of lower order in the half cells
  // along its rim, which have half of the error. The estimate assumes second order and gives two
  // thirds to three quarters of the error. The bound is 4.4 times the estimate (surface_error.h),
  // hence 2.9 to 3.4 times the truth.
  const LitPlate plate;
  const tests::Prepared prepared(plate.scene);
  for (const double edge_m : {0.25, 0.125}) {
    const radiosity::Solution solution = prepared.solve(even(edge_m));
    const SurfaceError error = error_of(prepared, solution, even(edge_m));
    const double truth = true_error(plate.scene, solution, [&](const scenes::Hit& hit) {
      const Vec3 p = point_of(plate.scene, hit);
      return LitPlate::truth(p.x, p.y);
    });
    ASSERT_TRUE(error.known);
    EXPECT_GT(error.parts.patches.estimate, 0.6 * truth) << edge_m;
    EXPECT_LT(error.parts.patches.estimate, 1.2 * truth) << edge_m;
    EXPECT_GE(error.parts.patches.bound_95, truth) << edge_m;
    EXPECT_LT(error.parts.patches.bound_95, 3.4 * truth) << edge_m;
    // Without interreflection only the sampling of the lamp is random.
    EXPECT_LT(error.parts.form_factors.estimate, 0.03 * truth);
  }
}

TEST(SurfaceError, CountsBothSidesOfASheet) {
  // A sheet lit from behind only has half the mean square and half the mean: sqrt(2) times the
  // plate's error. The sample points differ.
  const LitPlate plate, sheet(true);
  const tests::Prepared one(plate.scene), two(sheet.scene);
  const double error = error_of(one, one.solve(even(0.125)), even(0.125)).parts.patches.estimate;
  const SurfaceError behind = error_of(two, two.solve(even(0.125)), even(0.125));
  ASSERT_TRUE(behind.known);
  EXPECT_NEAR(behind.parts.patches.estimate / error, std::sqrt(2.0), 0.1);
}

TEST(SurfaceError, IsMadeOutByAFinerCutWhereThereIsNoCoarser) {
  LitPlate plate;
  plate.scene.lamps.at(0).position.z = 5.0;  // too far away for the plate to be divided
  const tests::Prepared prepared(plate.scene);
  const radiosity::Solution solution = prepared.solve(even(1.0));
  ASSERT_EQ(solution.patches.count(), 1U);
  const SurfaceError error = error_of(prepared, solution, even(1.0));
  EXPECT_GE(error.parts.patches.bound_95, 0.0);
  EXPECT_TRUE(error.known);
}

TEST(SurfaceError, OfAHardShadowOnRefinedPatchesLiesWithinItsBound) {
  // The Sun on half of the plate, with an oblique shadow edge.
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  builder.quad(builder.material(tests::grey(0.0)), {-0.6, -0.6, 0.5}, {0.361, -0.6, 0.5},
               {-0.041, 0.6, 0.5}, {-1.002, 0.6, 0.5});
  builder.scene.sun = tests::overhead_sun(1000.0);
  const tests::Prepared prepared(builder.scene);
  const auto truth = [&](const scenes::Hit& hit) {
    const Vec3 p = point_of(builder.scene, hit);
    return p.z == 0.0 && p.x > 0.361 - 0.335 * (p.y + 0.6) ? 500.0 : 0.0;
  };
  for (const std::size_t patches : {100U, 300U}) {
    radiosity::SolveOptions options = even(0.02);
    options.refine = {true, 0.25, patches, 0.0};
    const radiosity::Solution solution = prepared.solve(options);
    const SurfaceError error = error_of(prepared, solution, options);
    const double off = true_error(builder.scene, solution, truth);
    EXPECT_GE(error.parts.total().bound_95, off) << patches;
    EXPECT_LT(error.parts.total().bound_95, 4.0 * off) << patches;
    EXPECT_GT(error.parts.patches.estimate, 0.25 * off) << patches;
  }
}

TEST(SurfaceError, OfARoomLiesWithinItsBound) {
  // Relative to a solution with 16 times the patches and 8 times the rays per patch.
  const tests::SmallRoom& room = tests::small_room();
  const SurfaceError error = surface_error(room.study(), room.solution, room.solver);
  radiosity::SolveOptions better = room.solver;
  better.patch_edge_m /= 4.0;
  better.form_factor_rays *= 8;
  better.seed = 2;
  const radiosity::Solution reference = room.prepared.solve(better);
  const double truth = true_error(room.scene, room.solution, Reader(reference));
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

// Two specks 180 m apart make a spot 0.7 m wide, wider than the patches at the shadow's edge. A
// patch's mean comes from 16 points, with an error of about 0.25 / 16^0.75 = 0.03 of the light
// where the edge crosses it, while the error at the points of half of the patch is half of the
// light.
TEST(SurfaceError, OfSpotsIsThatOfTheirMeans) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 1.0, 0.0, true);
  const std::uint32_t black = builder.material(tests::grey(0.0));
  builder.quad(black, {-0.6, -0.6, 0.5}, {0.361, -0.6, 0.5}, {-0.041, 0.6, 0.5},
               {-1.002, 0.6, 0.5});
  for (const double x : {-90.0, 90.0}) {
    builder.quad(black, {x, 0, 0}, {x + 0.01, 0, 0}, {x + 0.01, 0.01, 0}, {x, 0.01, 0});
  }
  builder.scene.sun = tests::overhead_sun(1000.0);
  const tests::Prepared prepared(builder.scene);
  const radiosity::Solution solution = prepared.solve(even(0.25));
  const SurfaceError error = error_of(prepared, solution, even(0.25));
  EXPECT_GT(error.unweighted, 0.3);
  EXPECT_LT(error.parts.total().estimate, 0.3 * error.unweighted);
}

}  // namespace
}  // namespace earthshine::raytrace
