// SPDX-License-Identifier: Apache-2.0
// The initial sampling of a coarse picture, and the points that it leaves to neighbours and later
// rounds.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "raytrace/adaptive/adaptive_render.h"
#include "raytrace/adaptive/allocator.h"
#include "raytrace/adaptive/sample_plan.h"
#include "raytrace/shade/shading_setup.h"
#include "tests/support/scene_builder.h"

namespace earthshine::raytrace {
namespace {

constexpr int edge_px = 96;

// A room lit by one of its walls, with or without a sheet in the middle.
scenes::Scene room(bool has_sheet) {
  tests::SceneBuilder builder;
  const std::uint32_t grey = builder.material(tests::grey(0.5));
  const std::uint32_t bright = builder.material(tests::grey(0.5, 100.0));
  builder.room({bright, grey, grey, grey, grey, grey});
  if (has_sheet) builder.plate(grey, 0.3, 0.2, true);
  return builder.scene;
}

// Chips of about a pixel float in it, each at its own height.
scenes::Scene room_with_chips() {
  tests::SceneBuilder builder;
  builder.scene = room(false);
  constexpr double edge = 0.012;
  for (int k = 0; k < 144; ++k) {
    const double x = 0.1 + 0.05 * (k % 12), y = 0.1 + 0.05 * (k / 12), z = 0.1 + 0.05 * (7 * k % 9);
    builder.quad(1, {x, y, z}, {x + edge, y, z}, {x + edge, y + edge, z}, {x, y + edge, z});
  }
  return builder.scene;
}

// Seen from a corner: the error is mostly due to gathering.
struct Looked {
  explicit Looked(bool denoised, scenes::Scene seen = room(false), std::uint64_t of_seed = 1)
      : denoise(denoised), seed(of_seed), scene(std::move(seen)) {}
  bool denoise;
  std::uint64_t seed;
  scenes::Scene scene;
  tests::Prepared prepared{scene};
  radiosity::Solution solution = [this] {
    radiosity::SolveOptions solve;
    solve.patch_edge_m = 0.25;
    solve.form_factor_rays = 64;
    return prepared.solve(solve);
  }();
  scenes::Camera camera = [] {
    scenes::Camera corner;
    corner.position = Vec3(0.95, 0.9, 0.6);
    corner.look_at = Vec3(0.4, 0.45, 0.2);
    corner.fov_deg = 60.0;
    return corner;
  }();
  RenderOptions options = [this] {
    RenderOptions of_a_coarse_picture;
    of_a_coarse_picture.columns = of_a_coarse_picture.rows = edge_px;
    of_a_coarse_picture.denoise = denoise;
    of_a_coarse_picture.error = 1.0;
    of_a_coarse_picture.seed = seed;
    of_a_coarse_picture.initial_sampling_pixels = 1U << 16U;
    return of_a_coarse_picture;
  }();
  // `sampled` has pointers to these.
  scenes::World world = prepared;
  ShadingSetup setup{world, solution, camera, options};
  RenderReport report;
  Sampled sampled =
      sample_picture(setup.shared(), setup.world(), setup.camera(), options, {}, report);
  [[nodiscard]] const GatherField& field() const { return *sampled.field; }
  // Whether the initial sampling skips that pixel.
  [[nodiscard]] bool leaves(std::size_t pixel) const {
    const int x = static_cast<int>(pixel % edge_px), y = static_cast<int>(pixel / edge_px);
    return (x + y) % 2 != 0 && field().is_interior(x, y);
  }
  [[nodiscard]] bool is_left_out(Gathered kind, int x, int y) const {
    return field().samples(kind, field().window().index(x, y)) == 0.0F;
  }
};

const Looked& looked() {
  static const Looked one(true);
  return one;
}

TEST(InitialSampling, LeavesNothingOutWhereNeighboursShareNothing) {
  const Looked alone(false);
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual}) {
    for (int y = 0; y < edge_px; ++y) {
      for (int x = 0; x < edge_px; ++x) ASSERT_FALSE(alone.is_left_out(kind, x, y));
    }
  }
}

TEST(InitialSampling, LeavesEverySecondPixelOfASurfaceToThoseBesideIt) {
  for (const Gathered kind : {Gathered::Solution, Gathered::Residual}) {
    int left_out = 0;
    for (int y = 0; y < edge_px; ++y) {
      for (int x = 0; x < edge_px; ++x) {
        const bool leaves = looked().leaves(looked().field().window().index(x, y));
        ASSERT_EQ(looked().is_left_out(kind, x, y), leaves) << x << ' ' << y;
        left_out += leaves ? 1 : 0;
      }
    }
    EXPECT_GT(left_out, edge_px * edge_px / 3);  // most of the room is walls
  }
}

TEST(InitialSampling, SharpLobesGetMoreRays) {
  // Two surfaces: a wall with a wide lobe, and a plate with a narrow one whose peak is 40 times
  // higher. If the camera sees both, few pixels show the plate, so that the mean is closer to the
  // wall's. The plate gets two rays times the ratio of its lobe to the mean, rounded down to a
  // power of two, at most 32; the wall gets two. Every second interior pixel has none.
  tests::SceneBuilder builder;
  scenes::Material wide = tests::grey(0.5, 1.0), sharp = tests::grey(0.1);
  wide.specular = Rgb(0.1);
  wide.shininess = 2.0;
  sharp.specular = Rgb(4.0);
  sharp.shininess = 50.0;
  const std::uint32_t of_wall = builder.material(wide), of_plate = builder.material(sharp);
  builder.room({of_wall, of_wall, of_wall, of_wall, of_wall, of_wall});
  builder.plate(of_plate, 0.2, 0.3, true);
  for (std::size_t v = builder.scene.vertices.size() - 4; v < builder.scene.vertices.size(); ++v) {
    builder.scene.vertices[v] += Vec3(0.4, 0.45, 0.0);
  }
  const Looked seen(0.25, builder.scene);
  const GatherField& field = seen.field();
  double sum = 0.0, count = 0.0;
  for (const GatherPoint& point : field.points()) {
    sum += double(point.lobe);
    count += point.lobe > 0.0F ? 1.0 : 0.0;
  }
  int plates = 0, left_out = 0;
  for (std::size_t p = 0; p < field.points().size(); ++p) {
    const double lobe = double(field.points()[p].lobe);
    if (lobe <= 0.0) continue;
    const double rays = double(field.samples(Gathered::Lobe, p)), times = lobe * count / sum;
    const bool of_the_plate = field.points()[p].material == of_plate;
    if (p < edge_px * edge_px && seen.leaves(p)) {
      EXPECT_EQ(rays, 0.0);
      ++left_out;
      continue;
    }
    plates += of_the_plate ? 1 : 0;
    if (of_the_plate) {
      EXPECT_GE(rays, 2.0 * std::min(32.0, times / 2.0));
      EXPECT_LE(rays, 2.0 * std::min(32.0, times));
    } else {
      EXPECT_EQ(rays, 2.0);
    }
  }
  EXPECT_GT(plates, 30);
  EXPECT_GT(left_out, edge_px * edge_px / 3);
}

// Also far from all other surfaces, as on the wall behind the border of a sheet.
TEST(InitialSampling, RaysBesideEdgesStartAllOverThePixel) {
  const Looked at_sheet(0.25, room(true));
  const GatherField& field = at_sheet.field();
  int beside = 0, alone = 0;
  for (int y = 0; y < edge_px; ++y) {
    for (int x = 0; x < edge_px; ++x) {
      const std::size_t p = field.window().index(x, y);
      if (field.points()[p].reach_m <= 0.0F) continue;
      if (field.is_interior(x, y)) {
        alone += field.origins_at(p) == 1 ? 1 : 0;
      } else {
        EXPECT_GT(field.origins_at(p), 1U) << x << ' ' << y;
        ++beside;
      }
    }
  }
  EXPECT_GT(beside, edge_px);
  EXPECT_GT(alone, edge_px);
}

// The blur there vanishes as everywhere else: at a price of squared error, such points get the
// fewest samples or four times as many. At least an eighth of all pixels, within four standard
// errors of the mean over twelve seeds, because chance selects them.
TEST(InitialSampling, WhatItLeavesOutIsSampledByRounds) {
  constexpr double seeds = 12.0;
  std::array<double, 2> sum{}, squared{};
  for (std::uint64_t seed = 1; seed <= std::uint64_t(seeds); ++seed) {
    const Looked one(0.25, room(false), seed);
    SamplePlanner planner(one.sampled.sums, &one.field(), sample_costs(&one.field()));
    const SamplePlan plan = planner.plan(0.0, 1e30);
    for (const Gathered kind : {Gathered::Solution, Gathered::Residual}) {
      const auto k = static_cast<std::size_t>(kind);
      int sampled = 0;
      for (int y = 0; y < edge_px; ++y) {
        for (int x = 0; x < edge_px; ++x) {
          if (!one.is_left_out(kind, x, y)) continue;
          const std::uint32_t more = plan.field[k][one.field().window().index(x, y)];
          sampled += more >= GatherField::fewest_samples(kind) ? 1 : 0;
        }
      }
      sum[k] += sampled, squared[k] += double(sampled) * sampled;
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const double mean = sum[k] / seeds;
    const double error = std::sqrt((squared[k] / seeds - mean * mean) / (seeds - 1.0));
    EXPECT_GT(mean + 4.0 * error, edge_px * edge_px / 8.0);
  }
}

// Isolated points are sampled by likely noise: at least three in four of those whose halves agree
// so well by chance that the likely noise is ten times the stated one. With the stated noise, one
// in five would be.
TEST(InitialSampling, HalvesThatAgreeByChanceAreLookedAtAgain) {
  int agree = 0, sampled = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Looked one(0.25, room_with_chips(), seed);
    SamplePlanner planner(one.sampled.sums, &one.field(), sample_costs(&one.field()));
    const SamplePlan plan = planner.plan(0.0, 1e30);
    for (const Gathered kind : {Gathered::Solution, Gathered::Residual}) {
      const Shared& shared = one.field().shared(kind);
      for (std::size_t p = 0; p < shared.variance_prior.size(); ++p) {
        if (shared.variance_prior[p] <= 10.0F * shared.squared_error[p]) continue;
        ++agree;
        sampled += plan.field[static_cast<std::size_t>(kind)][p] > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(agree, 50);
  EXPECT_GT(4 * sampled, 3 * agree);
}

}  // namespace
}  // namespace earthshine::raytrace
