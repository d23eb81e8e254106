// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "radiosity/objects/form_factors.h"
#include "tests/support/exact_cube.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

ObjectFormFactors by_rays(const scenes::Scene& scene, double edge_m, int rays,
                          std::uint64_t seed = 1, bool raw = false) {
  const scenes::RayQuery query(scene);
  ObjectFactorReport report;
  return object_form_factors_by_rays(scene, query, subdivide(scene, edge_m), {rays, seed, raw},
                                     report);
}

void expect_factor(const ObjectFormFactors& objects, std::size_t i, std::size_t j, double exact) {
  EXPECT_NEAR(objects.F[i][j], exact, 4.0 * objects.std_error[i][j]) << i << " to " << j;
}

TEST(ObjectFormFactor, FacingUnitSquaresOneMetreApartMatchTheClosedForm) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const ObjectFormFactors o = by_rays(builder.scene, 0.25, 4096);
  expect_factor(o, 0, 1, 0.19982489569838);
  expect_factor(o, 1, 0, 0.19982489569838);
  EXPECT_NEAR(o.sky[0] + o.F[0][1], 1.0, 1e-12);
}

TEST(ObjectFormFactor, PerpendicularUnitSquaresWithACommonEdgeMatchTheClosedForm) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(m, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  const ObjectFormFactors o = by_rays(builder.scene, 0.25, 4096);
  expect_factor(o, 0, 1, 0.2000437760754);
}

TEST(ObjectFormFactor, ABlockerAtHalfHeightTakesItsExactShare) {
  // Mid-plane blockers of side 0.25, 0.5, 0.75 between unit squares 1 m apart (a ray is blocked if
  // and only if its midpoint is in the blocker).
  const double side[] = {0.25, 0.5, 0.75};
  const double exact[] = {0.16947420491179, 0.099506294598985, 0.02948354491476};
  for (int k = 0; k < 3; ++k) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    scenes::Material sheet = tests::grey(0.5);
    sheet.two_sided = true;
    const std::uint32_t thin = builder.material(sheet);
    builder.plate(m, 1.0, 0.0, true);
    builder.plate(m, 1.0, 1.0, false);
    builder.plate(thin, side[k], 0.5, true);
    expect_factor(by_rays(builder.scene, 0.25, 4096), 0, 1, exact[k]);
  }
}

TEST(ObjectFormFactor, RaysGoOnFromAMirrorAndTheRowStillCloses) {
  // A room whose ceiling is a perfect mirror: by the method of images the floor sees itself at
  // twice the distance, F(floor, floor) = F of facing unit squares 2 m apart = 0.068589588818552.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(1.0);
  const std::uint32_t ceiling = builder.material(mirror);
  builder.room({m, m, m, m, m, ceiling});
  const ObjectFormFactors o = by_rays(builder.scene, 0.25, 4096);
  expect_factor(o, 4, 4, 0.068589588818552);
  EXPECT_LE(o.max_row_error, 1e-12);
}

// Over many seeds the mean square of (F - exact) / std_error is 1 if the standard errors are
// correct. Each standard error has n = 50 or more degrees of freedom here (16 replicates of every
// patch and 64 sign patterns) and thus a relative error of 1 / sqrt(2 n). The mean square over m
// values is therefore within 4 sqrt(2 / m) of 1, and up to 4 % above.
void expect_honest(double mean_square, double m, const char* what) {
  EXPECT_NEAR(mean_square, 1.0, 4.0 * std::sqrt(2.0 / m) + 0.04) << what;
}

TEST(ObjectFormFactor, StandardErrorsAreHonestOverManySeeds) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  constexpr double exact = 0.19982489569838;
  constexpr int seeds = 200;
  for (const bool raw : {false, true}) {
    double square = 0.0, sky_square = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const ObjectFormFactors o = by_rays(builder.scene, 0.25, 256, seed, raw);
      const double z = (o.F[0][1] - exact) / o.std_error[0][1];
      const double sky = (o.sky[0] - (1.0 - exact)) / o.sky_std_error[0];
      EXPECT_LE(std::abs(z), 4.5);
      square += z * z / seeds;
      sky_square += sky * sky / seeds;
    }
    expect_honest(square, seeds, raw ? "raw" : "reconciled");
    expect_honest(sky_square, seeds, raw ? "raw sky" : "reconciled sky");
  }
}

TEST(ObjectFormFactor, StandardErrorsOfAClosedRoomAreHonestToo) {
  // Facing unit squares 0.19982489569838, perpendicular ones 0.2000437760754 of a cube.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  constexpr int seeds = 60;
  double facing = 0.0, perpendicular = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const ObjectFormFactors o = by_rays(builder.scene, 0.25, 256, seed);
    for (std::size_t i = 0; i < 6; i += 2) {
      const double z = (o.F[i][i + 1] - 0.19982489569838) / o.std_error[i][i + 1];
      const double p = (o.F[i][(i + 2) % 6] - 0.2000437760754) / o.std_error[i][(i + 2) % 6];
      facing += z * z / (3 * seeds);
      perpendicular += p * p / (3 * seeds);
    }
  }
  // The three pairs of a room are correlated through its rows: they count as one.
  expect_honest(facing, seeds, "facing");
  expect_honest(perpendicular, seeds, "perpendicular");
}

TEST(ObjectFormFactor, ReconciledTablesAreReciprocalAndClosed) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 3.0, 0.4, false);
  builder.quad(m, {0.6, -1, 0}, {0.6, 1, 0}, {0.6, 1, 0.3}, {0.6, -1, 0.3});  // with a visible back
  const ObjectFormFactors raw = by_rays(builder.scene, 0.3, 256, 1, true);
  const ObjectFormFactors o = by_rays(builder.scene, 0.3, 256);
  EXPECT_GT(raw.max_reciprocity_error, 1e-4);
  EXPECT_LE(raw.max_row_error, 1e-12);
  EXPECT_LE(o.max_reciprocity_error, 1e-12);
  EXPECT_LE(o.max_row_error, 1e-12);
  EXPECT_GT(o.black[0], 0.0);
}

TEST(ObjectFormFactor, ASpeckThatNoWallRayMeetsHasItsFactorFromItsOwnRays) {
  // A millimetre square 1 m above the middle of a 10 m square: reciprocity gives F(wall, speck) =
  // F(speck, wall) A_speck / A_wall. From a point at height h over the middle of a square of side
  // 2a, X = a / h = 5: four times the corner's (1 / 2 pi) (X / r atan(Y / r) + Y / r atan(X / r)),
  // Y = X, r = sqrt(1 + X^2) (Howell B-3); the small square's size changes it by less than 1e-6.
  const double x = 5.0, root = std::sqrt(1.0 + x * x);
  const double up = 4.0 / base::pi * (x / root) * std::atan(x / root);
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 10.0, 0.0, true);
  builder.plate(m, 1e-3, 1.0, false);
  const ObjectFormFactors o = by_rays(builder.scene, 1.0, 1024);
  expect_factor(o, 1, 0, up);
  EXPECT_NEAR(o.F[0][1] / (up * 1e-8), 1.0, 4.0 * o.std_error[0][1] / (up * 1e-8));
  EXPECT_LE(o.std_error[0][1], 0.02 * up * 1e-8);
}

TEST(ObjectFormFactor, ReplicatesThatAllFindTheSameAreStillInDoubtByOneHit) {
  // A plate of one patch 1 cm under a large one: all 16 rays of each replicate land there, as
  // 0.99999 of them should. Their variance is 0; one hit more or less among 256 rays is 1 / 256.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 0.01, 0.0, true);
  builder.plate(m, 10.0, 0.01, false);
  const ObjectFormFactors o = by_rays(builder.scene, 20.0, 256, 1, true);
  EXPECT_NEAR(o.F[0][1], 1.0, 1e-14);  // sum of sixteen sixteenths
  EXPECT_NEAR(o.std_error[0][1], 1.0 / 256.0, 1e-12);
}

TEST(ObjectFormFactor, TwoEstimatesThatDisagreeWidenTheError) {
  // A plate hidden by another one 15 um above it, 100 m from the centre of detail, a plate of 1 mm.
  // Rays start 24 um above their patch there: the hidden plate sees the ceiling, 0.1998, the
  // ceiling does not see it. The true value is 0.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 100.0, true);
  builder.plate(m, 1.0, 100.0 + 1.5e-5, true);
  builder.plate(m, 1.0, 101.0, false);
  builder.plate(m, 1e-3, 0.0, false);
  const scenes::RayQuery query(builder.scene);
  ObjectFactorReport report;
  const ObjectFormFactors o = object_form_factors_by_rays(
      builder.scene, query, subdivide(builder.scene, 0.25), {4096, 1, false}, report);
  EXPECT_EQ(report.disagreeing_pairs, 1U);
  EXPECT_GT(o.F[0][2], 0.05);
  EXPECT_LE(o.F[0][2], 4.0 * o.std_error[0][2]);
  EXPECT_LE(o.std_error[1][2], 0.01);  // the visible plate
}

TEST(ObjectFormFactor, SameBytesOnOneAndTwoThreads) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 0.5, false);
  ObjectFormFactors one, two;
  {
    const base::ThreadLimit limit(1);
    one = by_rays(builder.scene, 0.1, 256);
  }
  {
    const base::ThreadLimit limit(2);
    two = by_rays(builder.scene, 0.1, 256);
  }
  EXPECT_EQ(one.F, two.F);
  EXPECT_EQ(one.std_error, two.std_error);
}

}  // namespace
}  // namespace earthshine::radiosity
