// SPDX-License-Identifier: Apache-2.0
#include "radiosity/linear_solve.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/numbers/random.h"
#include "tests/support/scene_builder.h"

namespace earthshine::radiosity {
namespace {

struct Room {
  Patches patches;
  FormFactors factors;
};

Room closed_room(double edge_m) {
  tests::SceneBuilder builder;
  const std::uint32_t wall = builder.material(tests::grey(0.5));
  builder.room({wall, wall, wall, wall, wall, wall});
  const scenes::RayQuery query(builder.scene);
  Room room{subdivide(builder.scene, edge_m), {}};
  room.factors = cast_form_factors(builder.scene, query, room.patches, {256, 1});
  balance(room.factors, room.patches.area_m2);
  return room;
}

std::vector<double> noise(std::size_t count, std::uint64_t item) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    values[k] = base::uniform(base::Key(3, base::Stream::Test, item), k);
  }
  return values;
}

Eigen::MatrixXd dense(const FormFactors& f) {
  const auto n = static_cast<Eigen::Index>(f.count());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < f.count(); ++i) {
    for (std::uint64_t e = f.row_start[i]; e < f.row_start[i + 1]; ++e) {
      const std::uint32_t j = f.column[e];
      matrix(Eigen::Index(i), Eigen::Index(j)) =
          f.row_scale[i] * double(f.hits[e]) * f.column_scale[j];
    }
  }
  return matrix;
}

TEST(LinearSolve, ProductOfAnyNumberOfColumnsIsTheMatrixTimesEach) {
  // 33 columns exceed one pass over the matrix.
  const Room room = closed_room(0.25);
  const Eigen::MatrixXd f = dense(room.factors);
  const auto n = static_cast<std::size_t>(f.rows());
  for (const std::size_t columns : {1U, 3U, 4U, 6U, 11U, 16U, 24U, 32U, 33U}) {
    const std::vector<double> x = noise(n * columns, columns);
    std::vector<double> y(x.size());
    multiply(room.factors, x, y, columns);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto rows = static_cast<Eigen::Index>(n), width = static_cast<Eigen::Index>(columns);
    const RowMajor wanted = f * Eigen::Map<const RowMajor>(x.data(), rows, width);
    const Eigen::Map<const RowMajor> found(y.data(), rows, width);
    // Sums of 96 products of numbers below 1: rounding of a few units in the last place.
    EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), 1e-14) << columns;
  }
}

TEST(LinearSolve, ToleranceBoundsTheErrorAgainstADirectSolve) {
  // Reflectances from 0 to 0.999999 mixed, and all equal to 0.999999, where a relative residual of
  // 1e-8 would leave an error of up to 1e-8 / (1 - rho) = 1 %.
  const Room room = closed_room(0.25);
  const Eigen::MatrixXd f = dense(room.factors);
  const Eigen::Index n = f.rows();
  for (const bool mixed : {false, true}) {
    Eigen::VectorXd rho = Eigen::VectorXd::Constant(n, 0.999999), source(n);
    const std::vector<double> draws = noise(static_cast<std::size_t>(n), 1);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (mixed && i % 3 == 0) rho[i] = i % 2 == 0 ? 0.0 : 0.9999;
      source[i] = i == 7 ? 1000.0 : draws[static_cast<std::size_t>(i)];
    }
    const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n) - rho.asDiagonal() * f;
    const Eigen::VectorXd exact = a.partialPivLu().solve(source);
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const LinearSolve found =
          solve_linear(room.factors, {source.begin(), source.end()},
                       {rho.data(), static_cast<std::size_t>(n)}, 1, tolerance);
      const double error =
          (Eigen::Map<const Eigen::VectorXd>(found.x.data(), n) - exact).cwiseAbs().maxCoeff() /
          exact.maxCoeff();
      EXPECT_LE(error, tolerance) << mixed;
      EXPECT_LE(found.error, tolerance) << mixed;
    }
  }
}

TEST(LinearSolve, JointSolveOfManyColumnsLeavesEveryColumnWithinTolerance) {
  const Room room = closed_room(0.25);
  const std::size_t n = room.factors.count(), columns = 3;
  std::vector<double> source(n * columns, 0.0), rho(n * columns);
  for (std::size_t i = 0; i < n; ++i) {
    source[i * columns] = i == 0 ? 1e9 : 0.0;  // a bright spot,
    source[i * columns + 1] = 1e-9;            // a faint uniform light, and nothing
    for (std::size_t c = 0; c < columns; ++c) rho[i * columns + c] = 0.3 + 0.3 * double(c);
  }
  const LinearSolve result = solve_linear(room.factors, source, rho, columns, 1e-10);
  EXPECT_LE(result.residual, 1e-10);
  EXPECT_LT(result.iterations, 40);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(result.x[i * columns + 1] / (1e-9 / 0.4), 1.0, 1e-9);
    EXPECT_EQ(result.x[i * columns + 2], 0.0);
  }
}

}  // namespace
}  // namespace earthshine::radiosity
