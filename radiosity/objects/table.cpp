// SPDX-License-Identifier: Apache-2.0
#include "radiosity/objects/table.h"

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <limits>
#include <numeric>

namespace earthshine::radiosity {

Reconciliation::Reconciliation(const ObjectTable& estimate, std::span<const double> area_m2,
                               std::span<const double> rays_per_m2)
    : area_m2_(area_m2.begin(), area_m2.end()),
      rays_per_m2_(rays_per_m2.begin(), rays_per_m2.end()),
      variance_(estimate) {
  average(variance_);
  const std::size_t n = estimate.objects();
  for (std::size_t i = 0; i < n; ++i) {
    double* row = variance_.row(i);
    for (std::size_t k = 0; k < n + 2; ++k) {
      const double rays = rays_per_m2_[i] + (k < n && k != i ? rays_per_m2_[k] : 0.0);
      row[k] = rays > 0.0 ? std::max(0.0, row[k]) / rays : 0.0;
    }
  }
}

void Reconciliation::average(ObjectTable& table) const {
  for (std::size_t i = 0; i < table.objects(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double rays = rays_per_m2_[i] + rays_per_m2_[k];
      if (rays <= 0.0) continue;
      const double x =
          (rays_per_m2_[i] * table.row(i)[k] + rays_per_m2_[k] * table.row(k)[i]) / rays;
      table.row(i)[k] = table.row(k)[i] = x;
    }
  }
}

void Reconciliation::apply(ObjectTable& table, bool closes_to_area) const {
  average(table);
  const std::size_t n = table.objects();
  const auto rows = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd matrix(rows, rows);
  Eigen::VectorXd missing(rows);
  for (std::size_t i = 0; i < n; ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    const std::span<const double> variance(variance_.row(i), n + 2), row(table.row(i), n + 2);
    for (std::size_t k = 0; k < n; ++k) matrix(r, static_cast<Eigen::Index>(k)) = variance[k];
    matrix(r, r) = std::accumulate(variance.begin(), variance.end(), 0.0);
    // Entries without variance are fixed.
    missing[r] = matrix(r, r) > 0.0 ? (closes_to_area ? area_m2_[i] : 0.0) -
                                          std::accumulate(row.begin(), row.end(), 0.0)
                                    : 0.0;
  }
  // The matrix is positive semidefinite, singular only for closed scenes. The equations are then
  // still consistent, so that conjugate gradients converge.
  Eigen::ConjugateGradient<Eigen::MatrixXd, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(std::numeric_limits<double>::epsilon());
  solver.setMaxIterations(4 * rows + 20);
  const Eigen::VectorXd l = solver.solve(missing);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n + 2; ++k) {
      // Entries of one row only (the object itself, the sky and black backs) depend on that row
      // only.
      const double own = l[static_cast<Eigen::Index>(i)];
      const double other = k < n && k != i ? l[static_cast<Eigen::Index>(k)] : 0.0;
      table.row(i)[k] += variance_.row(i)[k] * (own + other);
    }
  }
}

}  // namespace earthshine::radiosity
