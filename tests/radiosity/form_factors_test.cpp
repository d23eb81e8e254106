// SPDX-License-Identifier: Apache-2.0
#include "radiosity/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

struct Cast {
  Patches patches;
  FormFactors factors;
  ObjectFormFactors objects;
};

Cast cast(const scenes::Scene& scene, double edge_m, int rays, std::uint64_t seed = 1) {
  const scenes::RayQuery query(scene);
  Cast result;
  result.patches = subdivide(scene, edge_m);
  result.factors = cast_form_factors(scene, query, result.patches, {rays, seed});
  result.objects = object_form_factors(scene, result.patches, result.factors);
  return result;
}

// 4 standard errors of the binomial count; Owen-Sobol points do better.
void expect_factor(const ObjectFormFactors& objects, std::size_t i, std::size_t j, double exact) {
  EXPECT_NEAR(objects.F[i][j], exact, 4.0 * objects.std_error[i][j]) << i << " to " << j;
}

TEST(FormFactor, FacingUnitSquaresOneMetreApartMatchTheClosedForm) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const Cast c = cast(builder.scene, 0.25, 4096);
  expect_factor(c.objects, 0, 1, 0.19982489569838);
  expect_factor(c.objects, 1, 0, 0.19982489569838);
  EXPECT_NEAR(c.objects.sky[0] + c.objects.F[0][1], 1.0, 1e-12);
}

TEST(FormFactor, PerpendicularUnitSquaresWithACommonEdgeMatchTheClosedForm) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.quad(m, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  const Cast c = cast(builder.scene, 0.25, 4096);
  expect_factor(c.objects, 0, 1, 0.2000437760754);
}

TEST(FormFactor, ABlockerAtHalfHeightTakesItsExactShare) {
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
    expect_factor(cast(builder.scene, 0.25, 4096).objects, 0, 1, exact[k]);
  }
}

TEST(FormFactor, EveryRowOfAnOpenSceneClosesToTheLastDigits) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, true);  // shows its black back to the first
  const Cast c = cast(builder.scene, 0.25, 1024);
  EXPECT_LE(c.objects.max_row_error, 1e-15);
  EXPECT_NEAR(c.objects.black[0], 0.19982489569838, 4 * 0.4 / std::sqrt(16.0 * 1024.0));
}

TEST(FormFactor, HitsAreWholeNumbersThatAddUpToTheRayCount) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  const Cast c = cast(builder.scene, 0.25, 1000);  // rounded up to 1024
  EXPECT_EQ(c.factors.rays_per_patch, 1024);
  for (std::size_t i = 0; i < c.factors.count(); ++i) {
    double sum = 0.0;
    for (std::uint64_t e = c.factors.row_start[i]; e < c.factors.row_start[i + 1]; ++e) {
      EXPECT_EQ(c.factors.hits[e], std::round(c.factors.hits[e]));
      sum += double(c.factors.hits[e]);
    }
    EXPECT_EQ(sum, 1024.0);
  }
}

TEST(FormFactor, NormalisedErrorsOverManySeedsStayWithinTheStatedStandardError) {
  // The binomial standard error is an upper bound for Owen-Sobol points: the mean square of
  // (F - exact) / std_error over 64 seeds must not exceed 1 by more than 4 sqrt(2 / 64) = 0.71, and
  // being an honest estimate rather than a wild one, must not fall to nothing.
  double mean_square = 0.0;
  for (std::uint64_t seed = 1; seed <= 64; ++seed) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.plate(m, 1.0, 0.0, true);
    builder.plate(m, 1.0, 1.0, false);
    const Cast c = cast(builder.scene, 1.0, 256, seed);
    const double z = (c.objects.F[0][1] - 0.19982489569838) / c.objects.std_error[0][1];
    mean_square += z * z / 64.0;
  }
  EXPECT_LT(mean_square, 1.71);
  EXPECT_GT(mean_square, 0.01);
}

TEST(FormFactor, SameBytesOnOneAndTwoThreads) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.room({m, m, m, m, m, m});
  FormFactors one, two;
  {
    const base::ThreadLimit limit(1);
    one = cast(builder.scene, 0.1, 256).factors;
  }
  {
    const base::ThreadLimit limit(2);
    two = cast(builder.scene, 0.1, 256).factors;
  }
  EXPECT_EQ(one.column, two.column);
  EXPECT_EQ(one.hits, two.hits);
  EXPECT_EQ(one.row_scale, two.row_scale);
}

TEST(FormFactor, RaysGoOnFromAMirrorAndTheRowStillCloses) {
  // A room whose ceiling is a perfect mirror: by the method of images the floor sees itself twice
  // as far away, F(floor, floor) = F of facing unit squares 2 m apart = 0.068589588818552.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  scenes::Material mirror = tests::grey(0.0);
  mirror.mirror = Rgb(1.0);
  const std::uint32_t ceiling = builder.material(mirror);
  builder.room({m, m, m, m, m, ceiling});
  const Cast c = cast(builder.scene, 0.25, 4096);
  expect_factor(c.objects, 4, 4, 0.068589588818552);
  EXPECT_LE(c.objects.max_row_error, 1e-12);
}

TEST(FormFactor, SkyIlluminanceOfAUniformSkyIsPiLTimesTheSkysShare) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, false);
  const scenes::RayQuery query(builder.scene);
  const Patches patches = subdivide(builder.scene, 0.5);
  const FormFactors factors = cast_form_factors(builder.scene, query, patches, {1024, 1},
                                                [](const Vec3&) { return Rgb(100.0); });
  for (std::size_t i = 0; i < factors.count(); ++i) {
    EXPECT_NEAR(factors.sky_illuminance[i].g, 100.0 * base::pi * factors.sky[i], 1e-9);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
