// SPDX-License-Identifier: Apache-2.0
// The decrease of an error with the amount spent: error = a x^-p, down to a floor.
//
//   error^2 = (a x^-p)^2 + floor^2
// The floor is the error by other settings; squares of independent errors add up. Fitted by least
// squares in the logarithm of the error (Gauss-Newton, damped after Levenberg and Marquardt). The
// model has a floor only if the points support it: with n points, if it reduces the sum of squares
// by more than 4 times the remainder per degree of freedom, S0 - S1 > 4 S1 / (n - 3). Standard
// error of p: from the inverse of the normal matrix and S / (degrees of freedom).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace earthshine::studies {

struct ErrorAt {
  double x = 0.0;  // amount: rays, patches, samples, lights
  double error = 0.0;
};

struct PowerLaw {
  double factor = 0.0;                   // a
  double exponent = 0.0;                 // p; positive: the error falls with x
  std::optional<double> exponent_error;  // standard error; empty without degrees of freedom
  double floor = 0.0;                    // 0: none
  std::size_t points = 0;
  [[nodiscard]] double error_at(double x) const;
  // Whether the points support the law: more points than parameters, an exponent from two standard
  // errors above 0 to 2.5, with a standard error of at most 0.25. Samples give 0.5, patches up to
  // 2.
  [[nodiscard]] bool holds() const;
};

// Ignores points with an error of 0, which are below the resolution. Empty if the others have fewer
// than two different x. Throws base::Error (Work) for a number that is not finite, an x that is not
// positive or an error that is negative.
[[nodiscard]] std::optional<PowerLaw> fit_power_law(const std::vector<ErrorAt>& points);

}  // namespace earthshine::studies
