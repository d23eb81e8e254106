// SPDX-License-Identifier: Apache-2.0
// The statistical error of an estimate.
#pragma once

#include <cmath>

namespace earthshine::raytrace {

// A part of an error, relative to the mean of the erroneous quantity.
struct ErrorEstimate {
  double estimate = 0.0;  // root mean square
  double bound_95 = 0.0;  // exceeded in one of twenty cases
};

// Adds errors of independent causes.
[[nodiscard]] inline ErrorEstimate operator+(const ErrorEstimate& a, const ErrorEstimate& b) {
  return {std::hypot(a.estimate, b.estimate), std::hypot(a.bound_95, b.bound_95)};
}

}  // namespace earthshine::raytrace
