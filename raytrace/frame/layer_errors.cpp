// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "raytrace/frame/frame.h"

namespace earthshine::raytrace {

void LayerNoise::add(std::span<const float> off) {
  products.resize(off.size() * (off.size() + 1) / 2, 0.0);
  double* product = products.data();
  for (std::size_t i = 0; i < off.size(); ++i) {
    const double own = double(off[i]);
    for (std::size_t j = 0; j <= i; ++j) *product++ += own * double(off[j]);
  }
}

double LayerNoise::of(std::span<const double> weights) const {
  if (products.empty()) return 0.0;
  double sum = 0.0;
  const double* product = products.data();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < i; ++j) row += weights[j] * *product++;
    sum += weights[i] * (2.0 * row + weights[i] * *product++);
  }
  return std::max(0.0, sum);
}

std::optional<double> LayerErrors::of(std::span<const double> weights) const {
  if (luminance.empty() || weights.size() != luminance.size()) return std::nullopt;
  double all = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < luminance.size(); ++k) {
    all += luminance[k];
    sum += weights[k] * luminance[k];
  }
  if (sum <= 0.0) return std::nullopt;
  const std::vector<double> ones(luminance.size(), 1.0);
  double squares = 0.0;
  for (std::size_t part = 0; part < noise.size(); ++part) {
    const double of_all = noise[part].of(ones);
    if (of_all > 0.0) squares += squared[part] * noise[part].of(weights) / of_all;
  }
  return std::sqrt(squares) * all / sum;
}

}  // namespace earthshine::raytrace
