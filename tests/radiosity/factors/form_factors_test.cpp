// SPDX-License-Identifier: Apache-2.0
#include "radiosity/factors/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "radiosity/objects/form_factors.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

struct Cast {
  Patches patches;
  FormFactors factors;
};

Cast cast(const scenes::Scene& scene, double edge_m, int rays, std::uint64_t seed = 1) {
  const scenes::RayQuery query(scene);
  Cast result;
  result.patches = subdivide(scene, edge_m);
  result.factors = cast_form_factors(scene, query, result.patches, {rays, seed});
  return result;
}

TEST(FormFactor, EveryRowOfAnOpenSceneClosesToTheLastDigits) {
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, true);  // its black back toward the first
  const Cast c = cast(builder.scene, 0.25, 1024);
  const ObjectFormFactors objects = object_form_factors(builder.scene, c.patches, c.factors);
  EXPECT_LE(objects.max_row_error, 1e-15);
  EXPECT_NEAR(objects.black[0], 0.19982489569838, 4 * 0.4 / std::sqrt(16.0 * 1024.0));
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
