// SPDX-License-Identifier: Apache-2.0
#include "radiosity/linear_solve.h"

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
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

using Vector = Eigen::VectorXd;

std::vector<double> column_norms(const Vector& values, std::size_t columns) {
  std::vector<double> norms(columns, 0.0);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    norms[static_cast<std::size_t>(k) % columns] += values[k] * values[k];
  }
  for (double& norm : norms) norm = std::sqrt(norm);
  return norms;
}

std::vector<double> column_maxima(const Vector& values, std::size_t columns) {
  std::vector<double> maxima(columns, 0.0);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    double& largest = maxima[static_cast<std::size_t>(k) % columns];
    largest = std::max(largest, std::abs(values[k]));
  }
  return maxima;
}

// Multiplies column c by scale[c]; a scale of 0 leaves its column 0.
void scale_columns(Vector& values, const std::vector<double>& scale) {
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    values[k] *= scale[static_cast<std::size_t>(k) % scale.size()];
  }
}

std::vector<double> inverse(std::vector<double> values) {
  for (double& value : values) value = value > 0.0 ? 1.0 / value : 0.0;
  return values;
}

class Solver {
 public:
  Solver(const FormFactors& factors, std::span<const double> reflectance, std::size_t columns)
      : system_(factors, reflectance, columns), columns_(columns) {
    krylov_.compute(system_);
    krylov_.setMaxIterations(300);
  }

  // The x of (1 - rho F) x = b to a joint relative residual, from x on.
  void improve(const Vector& b, double wanted, Vector& x, int& iterations) {
    krylov_.setTolerance(wanted);
    const Vector found = krylov_.solveWithGuess(b, x);
    iterations += static_cast<int>(krylov_.iterations());
    if (found.allFinite() && rest(b, found).squaredNorm() <= rest(b, x).squaredNorm()) {
      x = found;
      return;
    }
    // BiCGSTAB can break down; bouncing the light once more a time never does.
    for (int bounce = 0; bounce < 1000; ++bounce, ++iterations) {
      const Vector left = rest(b, x);
      if (left.norm() <= wanted * b.norm()) break;
      x += left;
    }
  }

  [[nodiscard]] Vector rest(const Vector& b, const Vector& x) const { return b - system_.apply(x); }

  // Adds to x what its residual asks for. Returns by how much it changed x: worst over the columns
  // of max |d| / max |x|.
  double correct(const Vector& b, Vector& x, int& iterations) {
    Vector left = rest(b, x);
    const std::vector<double> size = column_norms(left, columns_);
    if (*std::max_element(size.begin(), size.end()) <= 0.0) return 0.0;
    scale_columns(left, inverse(size));
    Vector d = left;
    improve(left, 0.01, d, iterations);
    scale_columns(d, size);
    x += d;
    const std::vector<double> change = column_maxima(d, columns_), all = column_maxima(x, columns_);
    double worst = 0.0;
    for (std::size_t c = 0; c < columns_; ++c) {
      if (all[c] > 0.0) worst = std::max(worst, change[c] / all[c]);
    }
    return worst;
  }

 private:
  RadiosityOperator system_;
  std::size_t columns_;
  Eigen::BiCGSTAB<RadiosityOperator, Eigen::IdentityPreconditioner> krylov_;
};

constexpr int most_corrections = 8;
constexpr double still_a_solution = 1e-6;

}  // namespace

LinearSolve solve_linear(const FormFactors& factors, std::span<const double> source,
                         std::span<const double> reflectance, std::size_t columns, double tolerance,
                         std::span<const double> guess) {
  LinearSolve result;
  result.x.assign(source.size(), 0.0);
  Vector b = Eigen::Map<const Vector>(source.data(), static_cast<Eigen::Index>(source.size()));
  const std::vector<double> norms = column_norms(b, columns);
  if (source.empty() || *std::max_element(norms.begin(), norms.end()) <= 0.0) return result;
  scale_columns(b, inverse(norms));

  Vector x = b;
  if (guess.size() == source.size()) {
    x = Eigen::Map<const Vector>(guess.data(), b.size());
    scale_columns(x, inverse(norms));
  }
  Solver solver(factors, reflectance, columns);
  solver.improve(b, tolerance / std::sqrt(static_cast<double>(columns)), x, result.iterations);
  result.error = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_corrections && result.error > tolerance; ++round) {
    const double previous = result.error;
    result.error = solver.correct(b, x, result.iterations);
    if (!(result.error < 0.5 * previous)) break;  // rounding is reached
  }
  const std::vector<double> left = column_norms(solver.rest(b, x), columns);
  result.residual = *std::max_element(left.begin(), left.end());
  if (!(result.error <= std::max(tolerance, still_a_solution))) {
    std::ostringstream found;
    found << "the solver stopped where the radiosity still changes by " << result.error
          << " of its largest value";
    throw base::Error(base::Blame::Work, "radiosity", found.str(),
                      "1e-6 is the largest that is still a solution",
                      "Lower reflectances that are nearly 1, or report the scene as a defect");
  }
  scale_columns(x, norms);
  std::copy(x.begin(), x.end(), result.x.begin());
  return result;
}

}  // namespace earthshine::radiosity
