// SPDX-License-Identifier: Apache-2.0
#include "radiosity/linear_solve.h"

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace earthshine::radiosity {
class RadiosityOperator;
}

// Eigen takes an operator without a matrix if it looks like a sparse one (Eigen's "Matrix-free
// solvers").
namespace Eigen::internal {
template <>
struct traits<earthshine::radiosity::RadiosityOperator>
    : public traits<Eigen::SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace earthshine::radiosity {

class RadiosityOperator : public Eigen::EigenBase<RadiosityOperator> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = 0
  };

  RadiosityOperator(const FormFactors& factors, std::span<const double> reflectance,
                    std::size_t columns)
      : factors_(factors), reflectance_(reflectance), columns_(columns) {}

  [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(reflectance_.size()); }
  [[nodiscard]] Eigen::Index cols() const { return rows(); }

  template <class Rhs>
  Eigen::Product<RadiosityOperator, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

  // (1 - rho F) x
  [[nodiscard]] Eigen::VectorXd apply(const Eigen::VectorXd& x) const {
    Eigen::VectorXd y(x.size());
    const auto size = static_cast<std::size_t>(x.size());
    multiply(factors_, {x.data(), size}, {y.data(), size}, columns_);
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      y[k] = x[k] - reflectance_[static_cast<std::size_t>(k)] * y[k];
    }
    return y;
  }

 private:
  const FormFactors& factors_;
  std::span<const double> reflectance_;
  std::size_t columns_;
};

}  // namespace earthshine::radiosity

namespace Eigen::internal {
template <class Rhs>
struct generic_product_impl<earthshine::radiosity::RadiosityOperator, Rhs, SparseShape, DenseShape,
                            GemvProduct>
    : generic_product_impl_base<
          earthshine::radiosity::RadiosityOperator, Rhs,
          generic_product_impl<earthshine::radiosity::RadiosityOperator, Rhs>> {
  template <class Dest>
  static void scaleAndAddTo(Dest& y, const earthshine::radiosity::RadiosityOperator& op,
                            const Rhs& x, const double& alpha) {
    y.noalias() += alpha * op.apply(x);
  }
};
}  // namespace Eigen::internal

namespace earthshine::radiosity {
namespace {

std::vector<double> column_norms(std::span<const double> values, std::size_t columns) {
  std::vector<double> norms(columns, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) norms[k % columns] += values[k] * values[k];
  for (double& norm : norms) norm = std::sqrt(norm);
  return norms;
}

}  // namespace

LinearSolve solve_linear(const FormFactors& factors, std::span<const double> source,
                         std::span<const double> reflectance, std::size_t columns,
                         double tolerance) {
  LinearSolve result;
  result.x.assign(source.size(), 0.0);
  const std::vector<double> norms = column_norms(source, columns);
  if (*std::max_element(norms.begin(), norms.end()) <= 0.0) return result;

  const auto size = static_cast<Eigen::Index>(source.size());
  Eigen::VectorXd b(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const double norm = norms[index % columns];
    b[k] = norm > 0.0 ? source[index] / norm : 0.0;
  }
  const RadiosityOperator system(factors, reflectance, columns);
  Eigen::BiCGSTAB<RadiosityOperator, Eigen::IdentityPreconditioner> solver;
  solver.compute(system);
  solver.setMaxIterations(200);
  // The joint residual bounds each column's share; tighter steps follow while a column is above
  // tolerance.
  Eigen::VectorXd x = b;
  double wanted = tolerance / std::sqrt(static_cast<double>(columns));
  for (int attempt = 0; attempt < 6; ++attempt, wanted *= 0.1) {
    solver.setTolerance(wanted);
    x = solver.solveWithGuess(b, x);
    result.iterations += static_cast<int>(solver.iterations());
    const Eigen::VectorXd rest = b - system.apply(x);
    const std::vector<double> left =
        column_norms({rest.data(), static_cast<std::size_t>(rest.size())}, columns);
    result.residual = *std::max_element(left.begin(), left.end());
    if (result.residual <= tolerance) break;
  }
  if (!(result.residual <= std::max(tolerance, 1e-6))) {
    std::ostringstream found;
    found << "the solver stopped at a relative residual of " << result.residual;
    throw base::Error(base::Blame::Work, "radiosity", found.str(),
                      "1e-6 is the largest that is still a solution",
                      "Lower reflectances that are nearly 1, or report the scene as a defect");
  }
  for (std::size_t k = 0; k < source.size(); ++k) {
    result.x[k] = x[static_cast<Eigen::Index>(k)] * norms[k % columns];
  }
  return result;
}

}  // namespace earthshine::radiosity
