// SPDX-License-Identifier: Apache-2.0
#include "base/numbers/gauss_rule.h"

#include <array>
#include <cmath>

#include "base/units.h"

namespace earthshine::base {
namespace {

// Roots of the Legendre polynomial by Newton's method, from Chebyshev's approximation.
GaussRule make_rule(int points) {
  GaussRule rule;
  for (int k = points; k > 0; --k) {
    double x = std::cos(pi * (k - 0.25) / (points + 0.5));
    double slope = 0.0;
    for (int step = 0; step < 50; ++step) {
      double here = 1.0, before = 0.0;
      for (int n = 0; n < points; ++n) {
        const double next = ((2.0 * n + 1.0) * x * here - n * before) / (n + 1.0);
        before = here;
        here = next;
      }
      slope = points * (x * here - before) / (x * x - 1.0);
      const double move = here / slope;
      x -= move;
      if (std::abs(move) < 1e-15) break;
    }
    rule.node.push_back(0.5 * (1.0 + x));
    rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace

const GaussRule& gauss_rule(int points) {
  static const auto rules = [] {
    std::array<GaussRule, most_gauss_points + 1> all;
    for (int n = 1; n <= most_gauss_points; ++n) all[static_cast<std::size_t>(n)] = make_rule(n);
    return all;
  }();
  return rules[static_cast<std::size_t>(points)];
}

}  // namespace earthshine::base
