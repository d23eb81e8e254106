// SPDX-License-Identifier: Apache-2.0
#include "radiosity/linear_solve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/free_memory.h"
#include "radiosity/factors/matrix_free.h"

namespace earthshine::radiosity {
namespace {

using Vector = Eigen::VectorXd;

// 1 - rho F. Of ranks that divide F the first asks for products, and the others serve().
class RadiosityOperator {
 public:
  RadiosityOperator(const FormFactors& factors, std::span<const double> reflectance,
                    std::size_t columns)
      : factors_(factors), reflectance_(reflectance), columns_(columns) {}

  [[nodiscard]] std::size_t size() const { return factors_.count() * columns_; }

  [[nodiscard]] Vector apply(const Vector& x) const {
    Vector y(x.size());
    product({x.data(), size()}, {y.data(), size()});
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      y[k] = x[k] - reflectance_[static_cast<std::size_t>(k)] * y[k];
    }
    return y;
  }

  // y = F x.
  void product(std::span<const double> x, std::span<double> y) const {
    ask_for_product(true);
    // Sent, and not changed.
    factors_.shares.tell_all(const_cast<double*>(x.data()), x.size());
    multiply(factors_, x, y, columns_);
    factors_.shares.tell_first(y.data(), columns_);
  }

  // Until the first rank is done.
  void serve() const {
    const auto [begin, end] = factors_.shares.own(factors_.count());
    std::vector<double> x(size()), y((end - begin) * columns_);
    while (ask_for_product(true)) {
      factors_.shares.tell_all(x.data(), x.size());
      multiply(factors_, x, y, columns_);
      factors_.shares.tell_first(y.data(), columns_);
    }
  }
  void end_service() const { ask_for_product(false); }

 private:
  // What the first rank says.
  bool ask_for_product(bool more) const {
    factors_.shares.tell_all(&more, 1);
    return more;
  }

  const FormFactors& factors_;
  std::span<const double> reflectance_;
  std::size_t columns_;
};

std::vector<double> column_norms(std::span<const double> values, std::size_t columns) {
  std::vector<double> norms(columns, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) norms[k % columns] += values[k] * values[k];
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

std::span<const double> span_of(const Vector& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

class Solver {
 public:
  Solver(const RadiosityOperator& system, std::size_t columns)
      : system_(system.size(), [&system](const Vector& x) { return system.apply(x); }),
        columns_(columns) {
    krylov_.compute(system_);
    krylov_.setMaxIterations(300);
  }

  // The x of (1 - rho F) x = b to a joint relative residual, from b on.
  [[nodiscard]] Vector solve(const Vector& b, double wanted) {
    krylov_.setTolerance(wanted);
    Vector x = krylov_.solveWithGuess(b, b);
    iterations += static_cast<int>(krylov_.iterations());
    if (x.allFinite() && rest(b, x).squaredNorm() <= rest(b, b).squaredNorm()) return x;
    // BiCGSTAB can break down; bouncing the light once more a time never does.
    x = b;
    for (int bounce = 0; bounce < 1000; ++bounce, ++iterations) {
      const Vector left = rest(b, x);
      if (left.norm() <= wanted * b.norm()) break;
      x += left;
    }
    return x;
  }

  [[nodiscard]] Vector rest(const Vector& b, const Vector& x) const {
    Vector left = system_.apply(x);
    left = b - left;
    return left;
  }

  // Adds to x what its residual asks for. Returns by how much it changed x: worst over the columns
  // of max |d| / max |x|.
  double correct(const Vector& b, Vector& x) {
    Vector left = rest(b, x);
    const std::vector<double> size = column_norms(span_of(left), columns_);
    if (*std::max_element(size.begin(), size.end()) <= 0.0) return 0.0;
    scale_columns(left, inverse(size));
    Vector d = solve(left, 0.01);
    scale_columns(d, size);
    x += d;
    const std::vector<double> change = column_maxima(d, columns_), all = column_maxima(x, columns_);
    double worst = 0.0;
    for (std::size_t c = 0; c < columns_; ++c) {
      if (all[c] > 0.0) worst = std::max(worst, change[c] / all[c]);
    }
    return worst;
  }

  int iterations = 0;

 private:
  MatrixFree system_;
  std::size_t columns_;
  Eigen::BiCGSTAB<MatrixFree, Eigen::IdentityPreconditioner> krylov_;
};

constexpr int most_corrections = 8;
constexpr double still_a_solution = 1e-6;

// b: scaled as the norms tell.
LinearSolve solve_scaled(const RadiosityOperator& system, const Vector& b,
                         const std::vector<double>& norms, double tolerance) {
  LinearSolve result;
  Solver solver(system, norms.size());
  Vector x = solver.solve(b, tolerance / std::sqrt(static_cast<double>(norms.size())));
  result.error = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_corrections && result.error > tolerance; ++round) {
    const double previous = result.error;
    result.error = solver.correct(b, x);
    if (!(result.error < 0.5 * previous)) break;  // rounding is reached
  }
  const std::vector<double> left = column_norms(span_of(solver.rest(b, x)), norms.size());
  result.residual = *std::max_element(left.begin(), left.end());
  result.iterations = solver.iterations;
  if (!(result.error <= std::max(tolerance, still_a_solution))) {
    std::ostringstream found;
    found << "the solver stopped where the radiosity still changes by " << result.error
          << " of its largest value";
    throw base::Error(base::Blame::Work, "radiosity", found.str(),
                      "1e-6 is the largest that is still a solution",
                      "Lower reflectances that are nearly 1, or report the scene as a defect");
  }
  scale_columns(x, norms);
  result.x.assign(x.begin(), x.end());
  return result;
}

}  // namespace

LinearSolve solve_linear(const FormFactors& factors, std::vector<double> source,
                         std::span<const double> reflectance, std::size_t columns,
                         double tolerance) {
  LinearSolve result;
  const RadiosityOperator system(factors, reflectance, columns);
  if (!factors.shares.joins()) {
    system.serve();
    return result;
  }
  const std::vector<double> norms = column_norms(source, columns);
  if (source.empty() || *std::max_element(norms.begin(), norms.end()) <= 0.0) {
    result.x.assign(source.size(), 0.0);
    result.fx = result.x;
  } else {
    Vector b = Eigen::Map<Vector>(source.data(), Eigen::Index(source.size()));
    base::release(source);
    scale_columns(b, inverse(norms));
    result = solve_scaled(system, b, norms, tolerance);
    b.resize(0);
    result.fx.resize(result.x.size());
    system.product(result.x, result.fx);
  }
  system.end_service();
  return result;
}

}  // namespace earthshine::radiosity
