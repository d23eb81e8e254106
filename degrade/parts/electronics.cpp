// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/electronics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

// Far above any white; keeps the later stages finite.
constexpr double endless = 1e12;

}  // namespace

Picture to_signal(Picture illuminance, double white_lux) {
  return transform(std::move(illuminance),
                   [&](double e) { return std::min(e / white_lux, endless); });
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

double bandwidth_variance(double bandwidth_mhz, int screen_columns) {
  const double f = bandwidth_mhz * active_line_us / screen_columns;  // cycles per resel
  if (f < 0.5) return 0.5 * std::log(2.0) / (1.0 - std::cos(2.0 * base::pi * f));
  return std::log(2.0) / (4.0 * base::pi * base::pi * f * f);
}

AxisMap line_filter(int columns, double bandwidth_mhz, double aperture_correction,
                    int screen_columns) {
  std::vector<double> taps = {1.0};
  if (bandwidth_mhz > 0.0) {
    taps = discrete_gaussian(std::sqrt(bandwidth_variance(bandwidth_mhz, screen_columns)));
  }
  if (aperture_correction > 0.0) {
    const double k = aperture_correction;
    std::vector<double> peaked(taps.size() + 2);
    for (std::size_t i = 0; i < taps.size(); ++i) {
      peaked[i] -= 0.5 * k * taps[i];
      peaked[i + 1] += (1.0 + k) * taps[i];
      peaked[i + 2] -= 0.5 * k * taps[i];
    }
    taps = std::move(peaked);
  }
  return symmetric_filter(columns, taps);
}

Picture weave(Picture first, const Picture& second) {
  const std::size_t width = static_cast<std::size_t>(first.columns);
  for (std::size_t p = 0; p < first.planes.size(); ++p) {
    for (std::size_t y = 1; y < static_cast<std::size_t>(first.rows); y += 2) {
      const auto begin = second.planes[p].begin() + static_cast<std::ptrdiff_t>(y * width);
      std::copy(begin, begin + static_cast<std::ptrdiff_t>(width),
                first.planes[p].begin() + static_cast<std::ptrdiff_t>(y * width));
    }
  }
  return first;
}

}  // namespace earthshine::degrade
