// SPDX-License-Identifier: Apache-2.0
// What two halves of the shadow rays find at a point is all or nothing, and how much its error
// counts goes by what it should be (error_weight): the one must not tell the other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "studies/steer/reach_surfaces.h"
#include "studies/surfaces/residual_error.h"
#include "tests/studies/room.h"

namespace earthshine::studies {
namespace {

// Halves of a penumbra, half lit, that is ten times as bright as the mean. The solution is right.
struct HalfLit {
  static constexpr double mean = 1.0, right = 10.0;
  static constexpr std::size_t count = 4096;
  ResidualSums sums;
  explicit HalfLit(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::bernoulli_distribution is_lit(0.5);
    sums.start(count);
    for (std::size_t n = 0; n < count; ++n) {
      sums.place(n, 0.5, 0.5, Rgb(1.0), Rgb(right), Rgb(right), Rgb(0.0));
      for (const std::size_t half : {0U, 1U}) {
        sums.set(n, half, Rgb(is_lit(random) ? 2.0 * right : 0.0), Rgb(0.0));
      }
    }
  }
  PatchResidual finish() {
    PatchResidual residual;
    sums.finish(mean, residual);
    return residual;
  }
};

// By their own values points whose halves both are dark count w = 1, those that both are lit
// 4 / 20: a quarter of r^2 (1 + 1 / 25) less half of it at (4 / 10)^2, 0.18 of 10^2 in place of 0.
TEST(Penumbra, ARightSolutionHasNoResidual) {
  HalfLit penumbra(1);
  for (std::size_t n = 0; n < HalfLit::count; ++n) {
    ASSERT_TRUE(penumbra.sums.is_unsure(n, HalfLit::mean));
    penumbra.sums.weigh_by(n, Rgb(HalfLit::right));
  }
  const PatchResidual residual = penumbra.finish();
  EXPECT_NEAR(residual.weight, 0.4, 1e-6);
  EXPECT_LT(std::abs(residual.square), 4.0 * residual.square_error);
  EXPECT_GT(0.18 * 100.0, 40.0 * double(residual.square_error));
  EXPECT_TRUE(residual.wants_shadow_rays);
}

// A point that is dark, or that all agree on, needs no further rays.
TEST(Penumbra, OfSurePointsNoMoreIsAsked) {
  ResidualSums sums;
  sums.start(2);
  sums.place(0, 0.5, 0.5, Rgb(1.0), Rgb(10.0), Rgb(10.0), Rgb(0.0));
  sums.place(1, 0.5, 0.5, Rgb(1.0), Rgb(1.0), Rgb(1.0), Rgb(0.0));
  for (const std::size_t half : {0U, 1U}) {
    sums.set(0, half, Rgb(11.0), Rgb(0.0));
    sums.set(1, half, Rgb(half == 0 ? 0.0 : 2.0), Rgb(0.0));
  }
  EXPECT_FALSE(sums.is_unsure(0, 1.0));
  EXPECT_FALSE(sums.is_unsure(1, 1.0));
}

// A floor of 4 x 4 m beneath two boards that leave a slit of 0.3 m to a wide Sun.
scenes::Scene slit() {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  builder.quad(m, {0, 0, 1}, {0, 4, 1}, {1.85, 4, 1}, {1.85, 0, 1});
  builder.quad(m, {2.15, 0, 1}, {2.15, 4, 1}, {4, 4, 1}, {4, 0, 1});
  scenes::Sun sun;
  sun.direction = Vec3(0, 0, 1);
  sun.illuminance_lx = Rgb(1000.0);
  sun.angular_radius_deg = 4.0;
  builder.scene.sun = sun;
  return builder.scene;
}

// Its penumbrae are 2 tan 4 deg = 0.14 m wide and 4 m long: squares of 1.5 cm, which follow them to
// a tenth, are 5000 in all. Where dark points count most, no patches are ever small enough. What is
// called reached is sure: sqrt(1.3 + 0.3 * 1.5 * 1.645) of what is asked for, at most.
TEST(Penumbra, IsReachedByPatchesAsSmallAsItNeeds) {
  const scenes::Scene scene = slit();
  const tests::Prepared prepared(scene);
  Wanted wanted;
  wanted.error = 0.1;
  const SteeredSolution found = reach_surfaces(prepared, wanted, 1, {});
  EXPECT_EQ(found.limit, Limit::None);
  EXPECT_LT(found.solution.patches.count(), 10000U);
  EXPECT_LT(found.surface.parts.total().bound_95, 1.43 * wanted.error);
}

}  // namespace
}  // namespace earthshine::studies
