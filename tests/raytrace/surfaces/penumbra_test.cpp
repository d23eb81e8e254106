// SPDX-License-Identifier: Apache-2.0
// In a penumbra, as in the light of a small bright source, each half of a point's rays finds all of
// the light or none. The weight of the point's error depends on its true brightness (error_weight),
// and must not depend on the chance of these halves.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "raytrace/solve_control/reach_surfaces.h"
#include "raytrace/surfaces/residual_sums.h"
#include "tests/studies/room.h"

namespace earthshine::raytrace {
namespace {

enum class By { Lamps, GatherRays };

// Points that each half lights by chance, ten times as bright as the mean. The solution is right.
struct HalfLit {
  static constexpr double mean = 1.0, right = 10.0;
  static constexpr std::size_t count = 4096;
  By by;
  ResidualSums sums;
  HalfLit(By by_what, std::uint32_t seed) : by(by_what) {
    std::mt19937 random(seed);
    std::bernoulli_distribution is_lit(0.5);
    sums.start(count);
    for (std::size_t n = 0; n < count; ++n) {
      sums.place(n, 0.5, 0.5, Rgb(1.0), Rgb(right), lamps(right), gathered(right));
      for (const std::size_t half : {0U, 1U}) {
        const double lx = is_lit(random) ? 2.0 * right : 0.0;
        sums.set(n, half, lamps(lx), gathered(lx));
      }
    }
  }
  [[nodiscard]] Rgb lamps(double lx) const { return Rgb(by == By::Lamps ? lx : 0.0); }
  [[nodiscard]] Rgb gathered(double lx) const { return Rgb(by == By::GatherRays ? lx : 0.0); }
  PatchResidual finish() {
    PatchResidual residual;
    sums.finish(mean, residual);
    return residual;
  }
};

// With weights from their own values, points with two dark halves have w = 1, points with two lit
// halves 4 / 20: a quarter of r^2 (1 + 1 / 25) minus half of it at (4 / 10)^2, 0.18 of 10^2 instead
// of 0.
TEST(Penumbra, ARightSolutionHasNoResidual) {
  for (const By by : {By::Lamps, By::GatherRays}) {
    HalfLit points(by, 1);
    for (std::size_t n = 0; n < HalfLit::count; ++n) {
      ASSERT_TRUE(points.sums.is_unsure(n, HalfLit::mean));
      points.sums.weigh_by(n, points.lamps(HalfLit::right), points.gathered(HalfLit::right));
    }
    const PatchResidual residual = points.finish();
    EXPECT_NEAR(residual.weight, 0.4, 1e-6);
    EXPECT_LT(std::abs(residual.square), 4.0 * residual.square_error);
    EXPECT_GT(0.18 * 100.0, 40.0 * double(residual.square_error));
    EXPECT_EQ(residual.wants_shadow_rays, by == By::Lamps);
  }
}

// One ray of a thousand finds a glint of a thousand times the mean. A half with such a ray is
// limited to twice the bright level, 2 x 4 means. The weight of the other half, with an error of 1,
// follows the further rays: 1 if they find nothing, 4 / 400 if they find 400 times the mean.
TEST(Penumbra, AGlintThatOneRayFindsIsNoMoreThanTwiceWhatIsBright) {
  for (const auto& [found, weight] : {std::pair{0.0, 1.0}, {400.0, 0.01}}) {
    ResidualSums sums;
    sums.start(1);
    sums.place(0, 0.5, 0.5, Rgb(1.0), Rgb(1.0), Rgb(0.0), Rgb(1.0));
    sums.set(0, 0, Rgb(0.0), Rgb(1001.0));
    sums.set(0, 1, Rgb(0.0), Rgb(0.0));
    ASSERT_TRUE(sums.is_unsure(0, 1.0));
    sums.weigh_by(0, Rgb(0.0), Rgb(found));
    PatchResidual residual;
    sums.finish(1.0, residual);
    EXPECT_FLOAT_EQ(residual.square, static_cast<float>(2.0 * 4.0 * -weight));
  }
}

// A dark point, or one whose halves agree, needs no further rays.
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

// A floor of 4 x 4 m beneath two boards with a slit of 0.3 m, under a wide Sun.
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

// Its penumbrae are 2 tan 4 deg = 0.14 m wide and 4 m long: 5000 squares of 1.5 cm follow them to a
// tenth. If dark points had the largest weight, no patches would be small enough. A reached error
// is certain: the bound is at most sqrt(1.3 + 0.3 * 1.5 * 1.645) of the wanted error.
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
}  // namespace earthshine::raytrace
