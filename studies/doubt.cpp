// SPDX-License-Identifier: Apache-2.0
#include "studies/doubt.h"

#include <algorithm>
#include <cmath>

namespace earthshine::studies {
namespace {

constexpr double most_modes = 100.0;  // the bound is within a sixth of the estimate there

}  // namespace

Doubt operator+(const Doubt& a, const Doubt& b) {
  return {std::hypot(a.estimate, b.estimate), std::hypot(a.bound_95, b.bound_95)};
}

double f_quantile_95(double m, double n) {
  constexpr double z = 1.6448536;
  // (a x - b)^2 = z^2 (2 / (9 n) x^2 + 2 / (9 m)) for x the cube root of F.
  const double a = 1.0 - 2.0 / (9.0 * n), b = 1.0 - 2.0 / (9.0 * m);
  const double p = std::max(1e-3, a * a - z * z * 2.0 / (9.0 * n));
  const double q = b * b - z * z * 2.0 / (9.0 * m);
  const double x = (a * b + std::sqrt(std::max(0.0, a * a * b * b - p * q))) / p;
  return x * x * x;
}

Spread spread_of(const std::vector<std::vector<double>>& tries) {
  const std::size_t count = tries.size(), values = tries.front().size();
  Spread spread;
  if (values == 0) return spread;
  std::vector<double> mean(values, 0.0);
  for (const auto& one : tries) {
    for (std::size_t i = 0; i < values; ++i) mean[i] += one[i] / static_cast<double>(count);
  }
  double trace = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t l = 0; l < count; ++l) {
      double product = 0.0;
      for (std::size_t i = 0; i < values; ++i) {
        product += (tries[k][i] - mean[i]) * (tries[l][i] - mean[i]);
      }
      if (k == l) trace += product;
      squares += product * product;
    }
  }
  const double free = static_cast<double>(count) - 1.0;
  spread.variance = trace / static_cast<double>(values) / free;
  if (squares <= 0.0) return spread;
  const double ratio = trace * trace / squares;
  const double most = std::min(most_modes, static_cast<double>(values));
  const double modes = (ratio * (free + 1.0) - 2.0) / std::max(1e-6, free - ratio);
  spread.modes = ratio < free ? std::clamp(modes, 1.0, std::max(1.0, most)) : std::max(1.0, most);
  return spread;
}

Doubt doubt_of(const Spread& spread, std::size_t tries, double share, double mean) {
  if (mean <= 0.0) return {};
  const double estimate = std::sqrt(spread.variance * share) / mean;
  const double free = static_cast<double>(tries) - 1.0;
  return {estimate, estimate * std::sqrt(f_quantile_95(spread.modes, free * spread.modes))};
}

}  // namespace earthshine::studies
