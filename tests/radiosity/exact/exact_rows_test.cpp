// SPDX-License-Identifier: Apache-2.0
// Open shares of exact rows, and pairs that are hard to integrate.
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/exact/form_factors.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

ExactFormFactors exact(const scenes::Scene& scene) {
  const scenes::RayQuery query(scene);
  return exact_form_factors(scene, query, subdivide(scene, 1e9), {});
}

TEST(ExactRows, AGapThatFewRaysFindIsNotScaledAway) {
  // Facing unit squares 2 mm, 0.1 mm and 7 um apart (Howell C-11, X = Y = 1 / h): the escaping
  // share, about 2 h, is usually missed by 256 rays.
  for (const double h : {2e-3, 1e-4, 7e-6}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.plate(m, 1.0, 0.0, true);
    builder.plate(m, 1.0, h, false);
    const FormFactors f = exact(builder.scene).factors;
    const double x = 1.0 / h, root2 = 1.0 + x * x, root = std::sqrt(root2);
    const double known = 2.0 / (base::pi * x * x) *
                         (0.5 * std::log(root2 * root2 / (1.0 + 2.0 * x * x)) +
                          2.0 * x * root * std::atan(x / root) - 2.0 * x * std::atan(x));
    EXPECT_NEAR(f.row_scale[0] * double(f.hits[0]), known, 1e-6) << h;
    EXPECT_NEAR(f.sky[0], 1.0 - known, 1e-6) << h;
  }
}

TEST(ExactRows, TheSplitBetweenSkyAndBacksHasItsError) {
  // A plate under the black back of another, unit squares 1 m apart: 0.19982489569838 to backs, the
  // rest to the sky, as divided by 256 rays.
  tests::SceneBuilder builder;
  const std::uint32_t m = builder.material(tests::grey(0.5));
  builder.plate(m, 1.0, 0.0, true);
  builder.plate(m, 1.0, 1.0, true);
  const ExactFormFactors e = exact(builder.scene);
  const double error = e.report.split_std_error[0];
  // Binomial: sqrt(0.2 * 0.8 / 256).
  EXPECT_NEAR(error, 0.025, 0.003);
  EXPECT_NEAR(e.factors.black[0], 0.19982489569838, 4.0 * error);
  EXPECT_NEAR(e.factors.sky[0] + e.factors.black[0], 1.0, 1e-15);
}

TEST(ExactRows, EdgesThatNearlyTouchAlongTheirLengthChangeLittleAndEnd) {
  // Perpendicular unit squares with a common edge (0.2000437760754). One of them is displaced and
  // rotated by the rounding of a file with six or fewer digits: F changes by about the
  // displacement. The work does not grow with length over gap.
  for (const double off : {1e-5, 1e-6, 1e-7, 1e-9, 1e-12}) {
    tests::SceneBuilder builder;
    const std::uint32_t m = builder.material(tests::grey(0.5));
    builder.quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    builder.quad(m, {-off, 0, off}, {0, 1, 2 * off}, {0, 1, 1}, {-off, 0, 1});
    const FormFactors f = exact(builder.scene).factors;
    double sum = 0.0;  // over the two triangles of the second square
    for (std::uint64_t e = 0; e < f.row_start[1]; ++e) sum += f.row_scale[0] * double(f.hits[e]);
    EXPECT_NEAR(sum, 0.2000437760754, 4.0 * off + 1e-7) << off;
  }
}

}  // namespace
}  // namespace earthshine::radiosity
