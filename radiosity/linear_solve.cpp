// SPDX-License-Identifier: Apache-2.0
#include "radiosity/linear_solve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/free_memory.h"
#include "radiosity/factors/row_sums.h"

namespace earthshine::radiosity {
namespace {

// Of own rows, row-major.
using Values = std::vector<double>;

// A = 1 - rho F, and loops over vectors distributed like the rows of F.
class RadiosityOperator {
 public:
  RadiosityOperator(const FormFactors& factors, std::span<const double> reflectance,
                    std::size_t columns)
      : factors_(factors),
        rows_(factors.shares.own(factors.count()).end - factors.shares.own(factors.count()).begin),
        reflectance_(reflectance),
        columns_(columns),
        period_(rows_ > 0 ? reflectance.size() / rows_ : columns) {}

  [[nodiscard]] std::size_t size() const { return rows_ * columns_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] const base::Shares& shares() const { return factors_.shares; }

  // y = F x.
  void product(const Values& x, Values& y) const { multiply(factors_, x, y, columns_); }

  // body(begin, end, sums): for values from `begin` to `end`. Returns the sums over all ranks.
  template <class Body>
  std::vector<double> sums(std::size_t each, Body body) const {
    return sums_over_rows(factors_, each, [&](std::size_t begin, std::size_t end, double* sums) {
      body(begin * columns_, end * columns_, sums);
    });
  }

  // Completes y = F x to y = x - rho y.
  void finish(const Values& x, Values& y, std::size_t begin, std::size_t end) const {
    for (std::size_t k = begin; k < end; k += columns_) {
      const double* const rho = &reflectance_[k / columns_ * period_];
      for (std::size_t c = 0; c < columns_; c += period_) {
        for (std::size_t p = 0; p < period_; ++p) {
          y[k + c + p] = x[k + c + p] - rho[p] * y[k + c + p];
        }
      }
    }
  }

  // left = b - A x. Returns its squared norm.
  double rest(const Values& b, const Values& x, Values& left) const {
    left.resize(size());
    product(x, left);
    return sums(1, [&](std::size_t begin, std::size_t end, double* sum) {
      finish(x, left, begin, end);
      for (std::size_t k = begin; k < end; ++k) left[k] = b[k] - left[k];
      sum[0] += dot(&left[begin], &left[begin], end - begin);
    })[0];
  }

  [[nodiscard]] std::vector<double> column_norms(const Values& values) const {
    std::vector<double> norms =
        sums(columns_, [&](std::size_t begin, std::size_t end, double* sum) {
          for (std::size_t k = begin; k < end; k += columns_) {
            for (std::size_t c = 0; c < columns_; ++c) sum[c] += values[k + c] * values[k + c];
          }
        });
    for (double& norm : norms) norm = std::sqrt(norm);
    return norms;
  }

  // Multiplies column c by scale[c]; a column with scale 0 becomes 0.
  void scale_columns(Values& values, const std::vector<double>& scale) const {
    (void)sums(0, [&](std::size_t begin, std::size_t end, const double*) {
      for (std::size_t k = begin; k < end; k += columns_) {
        for (std::size_t c = 0; c < columns_; ++c) values[k + c] *= scale[c];
      }
    });
  }

 private:
  const FormFactors& factors_;
  std::size_t rows_;
  std::span<const double> reflectance_;
  std::size_t columns_, period_;
};

std::vector<double> inverse(std::vector<double> values) {
  for (double& value : values) value = value > 0.0 ? 1.0 / value : 0.0;
  return values;
}

class Solver {
 public:
  explicit Solver(const RadiosityOperator& system) : system_(system) {}

  // Solves A x = b to a joint relative residual, starting at b.
  [[nodiscard]] Values solve(const Values& b, double wanted) {
    double first = 0.0, bound = 0.0;
    Values x = stabilised(b, wanted, first, bound), left;
    if (system_.rest(b, x, left) <= first) return x;
    // BiCGSTAB may break down; Neumann iteration always converges.
    x = b;
    for (int bounce = 0; bounce < 1000; ++bounce, ++iterations) {
      if (system_.rest(b, x, left) <= bound) break;
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += left[k];
    }
    return x;
  }

  // One step of iterative refinement. Returns the relative change of x: maximum over the columns of
  // max |d| / max |x|.
  double correct(const Values& b, Values& x) {
    Values left;
    (void)system_.rest(b, x, left);
    const std::vector<double> size = system_.column_norms(left);
    if (*std::max_element(size.begin(), size.end()) <= 0.0) return 0.0;
    system_.scale_columns(left, inverse(size));
    Values d = solve(left, 0.01);
    system_.scale_columns(d, size);
    const std::size_t columns = system_.columns();
    std::vector<double> largest(2 * columns, 0.0);  // of d, of x
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[k] += d[k];
      double &change = largest[k % columns], &all = largest[columns + k % columns];
      change = std::max(change, std::abs(d[k]));
      all = std::max(all, std::abs(x[k]));
    }
    keep_largest(system_.shares(), largest);
    double worst = 0.0;
    for (std::size_t c = 0; c < columns; ++c) {
      if (largest[columns + c] > 0.0) worst = std::max(worst, largest[c] / largest[columns + c]);
    }
    return worst;
  }

  int iterations = 0;

 private:
  // BiCGSTAB (van der Vorst 1992). Returns also the initial squared residual (first) and its
  // required bound (bound).
  Values stabilised(const Values& b, double wanted, double& first, double& bound) {
    constexpr int most_iterations = 300;
    constexpr double rounding = std::numeric_limits<double>::epsilon();
    Values x = b, r, v(b.size());
    double square = system_.rest(b, x, r), shadow = square;  // r r, r0 r
    first = square;
    bound = wanted * wanted * dots(b, b);
    Values r0 = r, p = r, t(b.size());
    double begun = square;  // r0 r0
    for (int i = 0; i < most_iterations && square > bound; ++i, ++iterations) {
      system_.product(p, v);
      const double alpha =
          shadow / system_.sums(1, [&](std::size_t begin, std::size_t end, double* sum) {
            system_.finish(p, v, begin, end);
            sum[0] += dot(&r0[begin], &v[begin], end - begin);
          })[0];
      (void)system_.sums(0, [&](std::size_t begin, std::size_t end, const double*) {
        for (std::size_t k = begin; k < end; ++k) r[k] -= alpha * v[k];
      });
      system_.product(r, t);
      const auto along = system_.sums(2, [&](std::size_t begin, std::size_t end, double* sum) {
        system_.finish(r, t, begin, end);
        sum[0] += dot(&t[begin], &r[begin], end - begin);
        sum[1] += dot(&t[begin], &t[begin], end - begin);
      });
      const double omega = along[1] > 0.0 ? along[0] / along[1] : 0.0;
      const auto found = system_.sums(2, [&](std::size_t begin, std::size_t end, double* sum) {
        for (std::size_t k = begin; k < end; ++k) x[k] += alpha * p[k] + omega * r[k];
        for (std::size_t k = begin; k < end; ++k) r[k] -= omega * t[k];
        sum[0] += dot(&r[begin], &r[begin], end - begin);
        sum[1] += dot(&r0[begin], &r[begin], end - begin);
      });
      square = found[0];
      double beta = found[1] / shadow * (alpha / omega);
      shadow = found[1];
      if (std::abs(shadow) < rounding * rounding * begun) {  // search direction lost: restart
        begun = shadow = square = system_.rest(b, x, r);
        r0 = r;
        beta = 0.0;
      }
      (void)system_.sums(0, [&](std::size_t begin, std::size_t end, const double*) {
        if (beta == 0.0) {
          std::copy(&r[begin], &r[begin] + (end - begin), &p[begin]);
          return;
        }
        for (std::size_t k = begin; k < end; ++k) p[k] = r[k] + beta * (p[k] - omega * v[k]);
      });
    }
    return x;
  }

  [[nodiscard]] double dots(const Values& a, const Values& b) const {
    return system_.sums(1, [&](std::size_t begin, std::size_t end, double* sum) {
      sum[0] += dot(&a[begin], &b[begin], end - begin);
    })[0];
  }

  const RadiosityOperator& system_;
};

constexpr int most_corrections = 8;
constexpr double still_a_solution = 1e-6;

// b: scaled by the norms.
LinearSolve solve_scaled(const RadiosityOperator& system, const Values& b,
                         const std::vector<double>& norms, double tolerance) {
  LinearSolve result;
  Solver solver(system);
  Values x = solver.solve(b, tolerance / std::sqrt(static_cast<double>(norms.size())));
  result.error = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_corrections && result.error > tolerance; ++round) {
    const double previous = result.error;
    result.error = solver.correct(b, x);
    if (!(result.error < 0.5 * previous)) break;  // limited by rounding
  }
  Values rest;
  (void)system.rest(b, x, rest);
  const std::vector<double> left = system.column_norms(rest);
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
  system.scale_columns(x, norms);
  result.x = std::move(x);
  return result;
}

}  // namespace

LinearSolve solve_linear(const FormFactors& factors, std::vector<double> source,
                         std::span<const double> reflectance, std::size_t columns,
                         double tolerance) {
  const RadiosityOperator system(factors, reflectance, columns);
  const std::vector<double> norms = system.column_norms(source);
  LinearSolve result;
  if (norms.empty() || *std::max_element(norms.begin(), norms.end()) <= 0.0) {
    result.x.assign(source.size(), 0.0);
    result.fx = result.x;
    return result;
  }
  system.scale_columns(source, inverse(norms));
  result = solve_scaled(system, source, norms, tolerance);
  base::release(source);
  result.fx.resize(result.x.size());
  system.product(result.x, result.fx);
  return result;
}

}  // namespace earthshine::radiosity
