// SPDX-License-Identifier: Apache-2.0
// Weighted least squares of a value that varies linearly with a few variables, for its value where
// all of them are zero.
#pragma once

#include <array>
#include <cstddef>

namespace earthshine::raytrace {

// variables: the constant 1 first. Sums w x x^T over the samples, then solves. A variable that the
// samples do not tell from those before it is left out: its coefficient is 0.
template <std::size_t variables>
class LocalFit {
 public:
  using Values = std::array<double, variables>;

  void add(double weight, const Values& x) {
    for (std::size_t i = 0; i < variables; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * x[i] * x[j];
    }
  }

  // L D L^T of the matrix (Golub and Van Loan, Matrix Computations, section 4.1), row by row.
  // Returns how many variables the samples span.
  std::size_t factor() {
    constexpr double independent = 1e-2;  // least part of a variable's spread that must be its own
    std::size_t spanned = 0;
    for (std::size_t i = 0; i < variables; ++i) {
      double pivot = matrix_[i][i];
      for (std::size_t j = 0; j < i; ++j) {
        double entry = matrix_[i][j];
        for (std::size_t k = 0; k < j; ++k) entry -= lower_[i][k] * lower_[j][k] * diagonal_[k];
        lower_[i][j] = diagonal_[j] > 0.0 ? entry / diagonal_[j] : 0.0;
        pivot -= lower_[i][j] * lower_[i][j] * diagonal_[j];
      }
      diagonal_[i] = pivot > independent * matrix_[i][i] ? pivot : 0.0;
      if (diagonal_[i] > 0.0) ++spanned;
    }
    return spanned;
  }

  // Coefficients for a right-hand side sum of w x y.
  [[nodiscard]] Values solve(Values y) const {
    for (std::size_t i = 0; i < variables; ++i) {
      for (std::size_t j = 0; j < i; ++j) y[i] -= lower_[i][j] * y[j];
    }
    for (std::size_t i = 0; i < variables; ++i) {
      y[i] = diagonal_[i] > 0.0 ? y[i] / diagonal_[i] : 0.0;
    }
    for (std::size_t i = variables; i-- > 0;) {
      for (std::size_t j = i + 1; j < variables; ++j) y[i] -= lower_[j][i] * y[j];
      if (diagonal_[i] <= 0.0) y[i] = 0.0;
    }
    return y;
  }

 private:
  std::array<Values, variables> matrix_{}, lower_{};
  Values diagonal_{};
};

}  // namespace earthshine::raytrace
