// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/electronics.h"

#include <algorithm>
#include <cmath>

namespace earthshine::degrade {
namespace {

// Far above anything a camera can tell from white; keeps later stages away from infinity.
constexpr double endless = 1e12;

}  // namespace

Picture to_signal(Picture illuminance, double white_lux) {
  return transform(std::move(illuminance),
                   [&](double e) { return std::min(e / white_lux, endless); });
}

Picture limit_below_zero(Picture signal) {
  return transform(std::move(signal), [](double s) { return std::max(s, 0.0); });
}

Picture amplify(Picture signal, double gain) {
  return transform(std::move(signal), [&](double s) { return s * gain; });
}

Picture encode_gamma(Picture signal, double gamma) {
  return transform(std::move(signal),
                   [&](double s) { return s > 0.0 ? std::pow(s, 1.0 / gamma) : 0.0; });
}

Picture quantise(Picture line_signal, int bits) {
  const double levels = std::ldexp(1.0, bits) - 1.0;
  return transform(std::move(line_signal),
                   [&](double v) { return std::round(std::clamp(v, 0.0, 1.0) * levels) / levels; });
}

Levels measure_levels(const Picture& signal, double black_noise) {
  const Plane luminance = luminance_plane(signal);
  std::size_t saturated = 0, crushed = 0;
  for (float value : luminance) {
    if (static_cast<double>(value) >= white_signal) ++saturated;
    if (static_cast<double>(value) <= black_noise) ++crushed;
  }
  const double count = static_cast<double>(luminance.size());
  return {static_cast<double>(saturated) / count, static_cast<double>(crushed) / count};
}

}  // namespace earthshine::degrade
