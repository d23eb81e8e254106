// SPDX-License-Identifier: Apache-2.0
// Laws of the residual r = S + T L~ - L~ and of its results.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/fill_solution.h"
#include "raytrace/solve_control/reach_surfaces.h"
#include "raytrace/surfaces/residual_error.h"
#include "tests/studies/room.h"
#include "tests/support/fine_meshes.h"

namespace earthshine::raytrace {
namespace {

// A closed room of 1 m with shining walls or a lamp.
scenes::Scene closed_room(double reflectance, double emission, bool lamp) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(reflectance, emission));
  builder.room({m, m, m, m, m, m});
  if (lamp) {
    scenes::Lamp one;
    one.name = one.group = "lamp";
    one.position = Vec3(0.5, 0.4, 0.7);
    one.intensity_cd = Rgb(100.0);
    builder.scene.lamps.push_back(one);
  }
  return builder.scene;
}

struct Solved {
  explicit Solved(scenes::Scene made, double edge_m = 0.25, int rays = 256,
                  double cluster_edge_m = 0.0)
      : scene(std::move(made)) {
    options.patch_edge_m = edge_m;
    options.form_factor_rays = rays;
    solution = radiosity::solve_keeping(
        prepared, options, radiosity::subdivide(scene, edge_m, cluster_edge_m), {}, factors);
  }
  [[nodiscard]] scenes::World study() const { return prepared; }
  // With all illuminances times a factor.
  [[nodiscard]] LightOnSurfaces light(float factor = 1.0F) const {
    radiosity::Solution changed = solution;
    for (auto* values : {&changed.direct_lx, &changed.indirect_lx}) {
      for (float& lx : *values) lx *= factor;
    }
    return {study(), std::move(changed), factors, double(options.form_factor_rays)};
  }
  scenes::Scene scene;
  tests::Prepared prepared{scene};
  radiosity::SolveOptions options;
  radiosity::FormFactors factors;
  radiosity::Solution solution;
};

SurfaceSamples sampled(const Solved& solved, const LightOnSurfaces& light, double points,
                       std::uint32_t pass = 1) {
  std::vector<std::uint32_t> all(light.patches().count());
  std::iota(all.begin(), all.end(), 0U);
  return SurfaceSampler(solved.study(), 1)
      .sample(light.light(), all, even_budget(light, points), pass, light.mean_radiosity(),
              light.bodies());
}

double luminous(const std::vector<double>& values, std::size_t patch, std::size_t columns) {
  Rgb sum(0.0);
  for (std::size_t k = 0; k < columns; ++k)
    sum[static_cast<int>(k % 3)] += values[patch * columns + k];
  return base::luminance(sum);
}

// A disk of radius r with exitance M and a facing point at distance d below its plane and x off its
// axis: E = M / 2 (1 - (x^2 + d^2 - r^2) / sqrt((x^2 + d^2 + r^2)^2 - 4 r^2 x^2)) (Hamilton and
// Morgan 1952). So near a disk, samples are drawn by solid angle, and some carry no light; all
// samples of a half must count.
TEST(SurfaceResidual, OfANearLampAllSamplesCount) {
  tests::SceneBuilder builder;
  builder.plate(builder.material(tests::grey(0.5)), 0.002, 0.0, true);
  scenes::Lamp lamp;
  lamp.name = lamp.group = "disk";
  lamp.kind = scenes::LampKind::Disk;
  constexpr double x = 0.1, d = 0.05, r = 0.15;
  const double all = x * x + d * d + r * r;
  const double exact =
      500.0 * (1.0 - (all - 2.0 * r * r) / std::sqrt(all * all - 4.0 * r * r * x * x));
  lamp.position = Vec3(x, 0.0, d);
  lamp.axis = Vec3(0, 0, -1);
  lamp.radius_m = r;
  lamp.exitance = Rgb(1000.0);
  builder.scene.lamps.push_back(lamp);
  const Solved plate(builder.scene, 0.002);
  for (const std::uint8_t rays : {std::uint8_t{1}, std::uint8_t{8}}) {
    SurfaceLight light = plate.light().light();
    light.shadow_rays.assign(light.count(), rays);
    double sum = 0.0, squares = 0.0;
    constexpr std::uint32_t passes = 64;
    for (std::uint32_t pass = 1; pass <= passes; ++pass) {
      const std::vector<std::uint32_t> which = {0};
      const std::vector<SampleBudget> budget = {{16, 0}};
      const double lx = luminous(
          SurfaceSampler(plate.study(), 1).sample(light, which, budget, pass, 1.0, nullptr).lamps,
          0, light.columns());
      sum += lx / passes;
      squares += lx * lx / passes;
    }
    const double error = std::sqrt((squares - sum * sum) / (passes - 1));
    EXPECT_NEAR(sum, exact, 4.0 * error) << int(rays);
    EXPECT_LT(error, 0.02 * exact);
  }
}

TEST(SurfaceResidual, OfAFurnaceIsZeroToRounding) {
  const Solved furnace(closed_room(0.5, 10.0, false));
  const LightOnSurfaces light = furnace.light();
  const SurfaceSamples samples = sampled(furnace, light, 1024.0);
  for (const PatchResidual& r : samples.residual) {
    EXPECT_LT(std::abs(base::luminance(Rgb(r.half[0]))), 1e-5 * 20.0);
    EXPECT_LT(std::abs(r.square), 1e-10 * 400.0);
  }
  const SurfaceError error = surface_error(furnace.study(), furnace.solution, furnace.options);
  ASSERT_TRUE(error.known);
  EXPECT_LT(error.parts.total().bound_95, 1e-5);
}

// L - L~ of twice the solution is minus the solution, of zero the solution: e has that mean.
TEST(SurfaceResidual, BringsBackASolutionThatIsTwiceAsBrightOrDark) {
  const Solved room(closed_room(0.6, 0.0, true), 0.25, 1024);
  const std::size_t columns = room.solution.columns;
  const double right = room.light().mean_radiosity();
  for (const float factor : {0.0F, 2.0F}) {
    constexpr int tries = 6;
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t pass = 1; pass <= tries; ++pass) {
      LightOnSurfaces light = room.light(factor);
      const SurfaceSamples samples = sampled(room, light, 1024.0, pass);
      std::vector<double> residual(light.patches().count() * columns);
      for (std::size_t k = 0; k < residual.size(); ++k) {
        residual[k] = 0.6 * (samples.lamps[k] + samples.gathered[k] -
                             double(light.light().lamps[k]) - double(light.light().gathered[k]));
      }
      const std::vector<double> more = light.brought(residual, columns);
      double found = 0.0, area = 0.0;
      for (std::uint32_t i = 0; i < light.patches().count(); ++i) {
        const double part = light.patches().area_m2[i];
        found += part *
                 (luminous(residual, i, columns) + 0.6 * luminous(more, light.coarse(i), columns));
        area += part;
      }
      sum += found / area;
      squares += found / area * found / area;
    }
    const double mean = sum / tries;
    const double spread = std::sqrt(std::max(0.0, squares / tries - mean * mean) / (tries - 1));
    // The solution has the noise of its rays; its mean is accurate to some per mille.
    EXPECT_NEAR(mean, (1.0 - double(factor)) * right, 4.0 * spread + 0.005 * right) << factor;
  }
}

// The product of halves has no noise in its mean: few rays and many give the same mean square.
TEST(SurfaceResidual, HalvesAreIndependent) {
  const Solved room(closed_room(0.8, 0.0, true), 0.25, 256);
  const LightOnSurfaces light = room.light();
  constexpr int tries = 48;
  std::array<double, 2> mean{}, error{};
  double noise = 0.0;  // of one half with few rays
  for (const std::size_t many : {0U, 1U}) {
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t pass = 1; pass <= tries; ++pass) {
      std::vector<std::uint32_t> all(light.patches().count());
      std::iota(all.begin(), all.end(), 0U);
      const std::vector<SampleBudget> budget(
          all.size(), SampleBudget{4, many == 0 ? std::uint16_t{8} : std::uint16_t{128}});
      const SurfaceSamples samples =
          SurfaceSampler(room.study(), 1)
              .sample(light.light(), all, budget, pass, light.mean_radiosity(), light.bodies());
      double square = 0.0;
      for (const PatchResidual& r : samples.residual) {
        square += r.square / double(all.size());
        if (many == 0) noise += 8.0 * r.mean_variance / double(all.size()) / tries;
      }
      sum += square;
      squares += square * square;
    }
    mean[many] = sum / tries;
    error[many] = std::sqrt((squares / tries - mean[many] * mean[many]) / (tries - 1));
  }
  const double apart = std::hypot(error[0], error[1]);
  EXPECT_NEAR(mean[0], mean[1], 4.0 * apart);
  EXPECT_GT(noise, 8.0 * apart);  // would be detected
}

TEST(SurfaceResidual, OfAnAllButBlackBoxIsThatOfDirectLight) {
  const Solved box(closed_room(0.01, 0.0, true));
  const LightOnSurfaces light = box.light();
  const SurfaceSamples samples = sampled(box, light, 4096.0);
  double all = 0.0, lamps = 0.0;
  for (std::uint32_t i = 0; i < light.patches().count(); ++i) {
    all += samples.residual[i].mean_square;
    lamps += samples.residual[i].lamps_mean_square;
  }
  EXPECT_GT(lamps, 0.0);
  EXPECT_NEAR(all / lamps, 1.0, 0.1);
}

// A cap of height h of a sphere of radius R outside a box has the area 2 pi R h (Archimedes),
// however few points of its patches are sampled.
TEST(SurfaceResidual, OfASliverThatLooksOutOfABodyTheAreaIsTold) {
  constexpr double h = 0.05;
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  tests::fine_sphere(builder, m, {0.0, 0.0, 0.0}, 1.0, 48);
  builder.room({m, m, m, m, m, m});
  // The inverted room: a body from -2 to 2, and up to 1 - h.
  for (std::size_t k = builder.scene.triangles.size() - 12; k < builder.scene.triangles.size(); ++k)
    std::swap(builder.scene.triangles[k].vertex[1], builder.scene.triangles[k].vertex[2]);
  for (std::size_t k = builder.scene.vertices.size() - 24; k < builder.scene.vertices.size(); ++k) {
    Vec3& p = builder.scene.vertices[k];
    p = Vec3(4.0 * p.x - 2.0, 4.0 * p.y - 2.0, p.z > 0.5 ? 1.0 - h : -2.0);
  }
  scenes::Lamp lamp;
  lamp.name = lamp.group = "lamp";
  lamp.position = Vec3(0.5, 0.0, 3.0);
  lamp.intensity_cd = Rgb(100.0);
  builder.scene.lamps.push_back(lamp);
  const Solved solved(builder.scene, 0.5, 32, 0.5);
  const LightOnSurfaces light = solved.light();
  const SurfaceSamples samples = sampled(solved, light, 64.0);
  const radiosity::Patches& patches = light.patches();
  double found = 0.0, variance = 0.0;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    if (!patches.facets[patches.facet[i]].is_cluster()) continue;
    const double open = double(samples.residual[i].open), area = patches.area_m2[i];
    found += area * open;
    // At least 32 candidates, 16 for each of two points.
    variance += area * area * open * (1.0 - open) / 32.0;
  }
  ASSERT_GT(variance, 0.0);
  EXPECT_NEAR(found, 2.0 * base::pi * h, 4.0 * std::sqrt(variance));
  EXPECT_LT(4.0 * std::sqrt(variance), 0.5 * found);
}

TEST(ReachSurfaces, OfABlackBoxThereIsNothingToReach) {
  const Solved box(closed_room(0.0, 0.0, true));
  Wanted wanted;
  wanted.error = 0.002;
  const SteeredSolution found = reach_surfaces(box.study(), wanted, 1, {});
  EXPECT_FALSE(found.surface.known);
  EXPECT_EQ(found.limit, Limit::None);
  EXPECT_LT(found.solution.patches.count(), 1000U);
}

TEST(ReachSurfaces, EnergyIsClosedAfterCorrection) {
  Wanted wanted;
  wanted.error = 0.05;
  const SteeredSolution found = reach_surfaces(tests::small_room().study(), wanted, 1, {});
  EXPECT_EQ(found.limit, Limit::None);
  EXPECT_LE(found.surface.parts.total().estimate, 0.05);
  for (const radiosity::GroupLedger& group : found.solution.report.groups) {
    EXPECT_LT(group.imbalance, 1e-9) << group.name;
    const double there = base::luminance(group.emitted_lm + group.landed_lm);
    EXPECT_GT(there, 0.0) << group.name;
    EXPECT_NEAR(base::luminance(group.absorbed_lm + group.escaped_lm), there, 1e-9 * there);
  }
}

TEST(ReachSurfaces, SameOnOneAndThreeThreads) {
  std::vector<std::vector<float>> light;
  for (const int threads : {1, 3}) {
    const base::ThreadLimit limit(threads);
    Wanted wanted;
    wanted.error = 0.1;
    light.push_back(reach_surfaces(tests::small_room().study(), wanted, 1, {}).solution.radiosity);
  }
  EXPECT_EQ(light[0], light[1]);
}

}  // namespace
}  // namespace earthshine::raytrace
