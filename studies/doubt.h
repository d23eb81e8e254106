// SPDX-License-Identifier: Apache-2.0
// How far off a value may be that was found by chance, when a few independent tries are all that is
// known about the chance.
#pragma once

#include <span>
#include <vector>

namespace earthshine::studies {

// A part of an error, relative to the mean of what it is an error of.
struct Doubt {
  double estimate = 0.0;  // root mean square
  double bound_95 = 0.0;  // exceeded once in twenty times
};

// Errors of independent causes.
[[nodiscard]] Doubt operator+(const Doubt& a, const Doubt& b);

// F with P(X < F) = 0.95 for the ratio X of two mean squares of m and n degrees of freedom, both
// 0.5 or more (Paulson 1942, within 6 % from m = n = 2 up).
[[nodiscard]] double f_quantile_95(double m, double n);

// Tries of the same values by independent chance.
struct Spread {
  double variance = 0.0;  // of one try, mean over the values
  // How many values could vary on their own: 1 where all go up and down together, and the more of
  // them the less the mean square of an error strays from its expectation. From the participation
  // ratio of the tries' products, (tr G)^2 / tr G^2, whose expectation for m independent normal
  // modes of equal size in n = tries - 1 degrees of freedom is (n m + 2) / (n + m + 1).
  double modes = 1.0;
};
// At least two tries, all of the same length.
[[nodiscard]] Spread spread_of(const std::vector<std::vector<double>>& tries);

// The error of something whose variance is `share` of that of a try, over `mean`.
[[nodiscard]] Doubt doubt_of(const Spread& spread, std::size_t tries, double share, double mean);

}  // namespace earthshine::studies
