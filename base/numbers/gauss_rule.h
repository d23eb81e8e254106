// SPDX-License-Identifier: Apache-2.0
// Gauss-Legendre rules on [0, 1].
#pragma once

#include <vector>

namespace earthshine::base {

inline constexpr int most_gauss_points = 24;

struct GaussRule {
  std::vector<double> node, weight;  // weights add up to 1
};

// The rule of 1 to most_gauss_points points, exact for polynomials of degree 2 points - 1.
[[nodiscard]] const GaussRule& gauss_rule(int points);

}  // namespace earthshine::base
