// SPDX-License-Identifier: Apache-2.0
#include "studies/sight/eye.h"

#include <algorithm>
#include <cmath>

namespace earthshine::studies {
namespace {

double log_threshold_of_cones(double x) {
  if (x <= -2.6) return -0.72;
  if (x >= 1.9) return x - 1.255;
  return std::pow(0.249 * x + 0.65, 2.7) - 0.72;
}

double log_threshold_of_rods(double x) {
  if (x <= -3.94) return -2.86;
  if (x >= -1.44) return x - 0.395;
  return std::pow(0.405 * x + 1.6, 2.18) - 2.86;
}

// In the dark, where the laws are level, so that no logarithm is infinite.
double log_luminance(double luminance) { return std::log10(std::max(luminance, 1e-12)); }

}  // namespace

double threshold_difference(double luminance) {
  const double x = log_luminance(luminance);
  return std::pow(10.0, std::min(log_threshold_of_cones(x), log_threshold_of_rods(x)));
}

double acuity_cycles_per_deg(double luminance) {
  return std::max(0.0, 17.25 * std::atan(1.4 * log_luminance(luminance) + 0.35) + 25.72);
}

double seeing_probability(double ratio, const EyeOptions& options) {
  if (!(ratio > 0.0)) return 0.0;
  return 1.0 - std::exp2(-std::pow(ratio, options.slope));
}

}  // namespace earthshine::studies
