// SPDX-License-Identifier: Apache-2.0
// The closed cube of 6 x 16 x 16 patches, with form factors in closed form: errors of rays, their
// convergence, and the resulting errors of the radiosity.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/cube_errors.h"

namespace earthshine {
namespace {

constexpr int n = 16;

const tests::ExactCube& cube() {
  static const tests::ExactCube made = tests::grey_cube(n);
  return made;
}

TEST(CubeLaw, TheClosedFormsCloseEveryRow) {
  for (const std::size_t i : {0U, 37U, 700U, 1535U}) {
    double sum = 0.0;
    for (std::size_t j = 0; j < cube().count(); ++j) sum += cube().form_factor(i, j);
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(CubeLaw, RowErrorFallsFasterThanTheSquareRootOfTheRays) {
  // Random rays: N^-0.5. Owen-Sobol points in four dimensions: 1.46 N^-0.596, measured elsewhere.
  const double at_1024 = tests::mean_row_error(cube(), tests::cast_cube(cube(), 1024));
  const double at_4096 = tests::mean_row_error(cube(), tests::cast_cube(cube(), 4096));
  const double at_16384 = tests::mean_row_error(cube(), tests::cast_cube(cube(), 16384));
  RecordProperty("row error at 1024, 4096, 16384 rays",
                 testing::PrintToString(std::array{at_1024, at_4096, at_16384}));
  EXPECT_LE(at_4096, 1.15e-2);
  EXPECT_LE(std::log(at_16384 / at_1024) / std::log(16.0), -0.58);
}

TEST(CubeLaw, BalancedRowsKeepTheIndirectLightRight) {
  radiosity::FormFactors f = tests::cast_cube(cube(), 1024);
  const std::vector<double> area(f.count(), 1.0 / (n * n));
  EXPECT_TRUE(radiosity::balance(f, area).balanced);
  const double dim = tests::indirect_error(cube(), f, 0.5);
  const double bright = tests::indirect_error(cube(), f, 0.99);
  RecordProperty("indirect error at rho 0.5, 0.99", testing::PrintToString(std::pair(dim, bright)));
  EXPECT_LE(dim, 6e-3);
  EXPECT_LE(bright, 1.2e-4);
}

TEST(CubeLaw, ASmallLampIsCarriedExplicitlyAndExactly) {
  // 2 x 2 patches of the ceiling emit. Their own light is known exactly, so that the error of the
  // light caused elsewhere is compared: B - M.
  const double error = tests::lamp_error(1024);
  RecordProperty("error", testing::PrintToString(error));
  EXPECT_LE(error, 2e-3);
}

}  // namespace
}  // namespace earthshine
