// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/entry_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/exact_cube.h"

namespace earthshine::radiosity {
namespace {

TEST(EntryErrors, NormalisedErrorsOfEntriesAndRowsHaveVarianceOne) {
  // The cube of 6 x 8 x 8 patches against its closed forms, 6 seeds: z = (F - exact) / std_error
  // over all entries with at least 4 expected hits, and |row error|^2 / row_std_error^2 over the
  // rows. The law is accurate to a few per cent (48 pilots x 7 degrees of freedom x some hundred
  // entries, divided into classes). Patches near an edge and distant ones share a class, hence the
  // tolerance 0.1.
  const tests::ExactCube cube(8, [](tests::SceneBuilder& builder, int, int, int) {
    if (builder.scene.materials.empty()) builder.material(tests::grey(0.5));
    return 0U;
  });
  const scenes::RayQuery query(cube.builder.scene);
  const Patches patches = subdivide(cube.builder.scene, 1.0);
  for (const int rays : {256, 4096}) {
    const RayErrorLaw law = measure_error_law(cube.builder.scene, query, patches, {rays, 99});
    double square = 0.0, entries = 0.0, rows = 0.0;
    constexpr int seeds = 6;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const FormFactors f = cast_form_factors(cube.builder.scene, query, patches, {rays, seed});
      std::vector<double> row(f.count());
      for (std::size_t i = 0; i < f.count(); ++i) {
        std::fill(row.begin(), row.end(), 0.0);
        std::vector<double> error(f.count(), 0.0);
        for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
          row[f.column[e]] = f.row_scale[i] * double(f.hits[e]);
          error[f.column[e]] = entry_std_error(law, f, i, e);
        }
        double square_error = 0.0;
        for (std::size_t j = 0; j < f.count(); ++j) {
          const double exact = cube.form_factor(i, j), d = row[j] - exact;
          square_error += d * d;
          if (exact * rays < 4.0) continue;
          // The error is compared with the law at the expected hits. At the hits found, small
          // counts would have small errors stated, and the mean ratio would not be 1 for any law.
          square += d * d / law.variance(exact * rays);
          entries += 1.0;
          if (row[j] * rays >= 32.0) {
            EXPECT_NEAR(error[j] / std::sqrt(law.variance(exact * rays)), 1.0, 1.0);
          }
        }
        const double stated = row_std_error(law, f, i);
        rows += square_error / (stated * stated) / double(f.count() * seeds);
      }
    }
    EXPECT_GT(entries, 10000.0);
    EXPECT_NEAR(square / entries, 1.0, 0.1) << rays;
    EXPECT_NEAR(rows, 1.0, 0.1) << rays;
    // Smaller than binomial: the gain is far below 1 for many hits.
    EXPECT_LT(law.variance(rays / 16.0) * rays / (1.0 / 16.0), 0.8);
  }
}

TEST(EntryErrors, AShareThatNoRayFoundHasTheErrorOfOneHit) {
  RayErrorLaw law;
  law.rays_per_patch = 1000;
  EXPECT_NEAR(std::sqrt(law.variance(0.0)), 1e-3, 1e-6);
  EXPECT_EQ(law.variance(0.0), law.variance(1.0));
}

}  // namespace
}  // namespace earthshine::radiosity
