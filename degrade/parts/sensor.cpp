// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "degrade/stage/axis_map.h"

namespace earthshine::degrade {
namespace {

// Replaces each value by f(value, value of `other` at the same position).
template <class F>
Picture combine(Picture picture, const Picture& other, F f) {
  for_each_run(picture, [&](std::size_t plane, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      float& value = picture.planes[plane][i];
      value = static_cast<float>(
          f(static_cast<double>(value), static_cast<double>(other.planes[plane][i])));
    }
  });
  return picture;
}

}  // namespace

Picture after_lag(Picture now, const Picture& before, double lag) {
  return combine(std::move(now), before,
                 [&](double x, double y) { return (1.0 - lag) * x + lag * y; });
}

Picture settled_charge(const Picture& still, const NoiseLaw& law, const NoiseKey& key, double lag) {
  const double shrink = std::sqrt((1.0 - lag) / (1.0 + lag));
  const Picture light = differ_in_sensitivity(still, law, key);
  return combine(add_grain(light, law, key), light,
                 [&](double noisy, double mean) { return mean + shrink * (noisy - mean); });
}

Picture smear_columns(Picture signal, double share) {
  const std::size_t width = static_cast<std::size_t>(signal.columns);
  for (Plane& plane : signal.planes) {
    std::vector<double> sum(width);
    for (std::size_t line = 0; line < plane.size(); line += width) {
      for (std::size_t x = 0; x < width; ++x) sum[x] += static_cast<double>(plane[line + x]);
    }
    const double factor = 10.0 * share / signal.rows;
    for (std::size_t line = 0; line < plane.size(); line += width) {
      for (std::size_t x = 0; x < width; ++x) {
        plane[line + x] =
            static_cast<float>(static_cast<double>(plane[line + x]) + factor * sum[x]);
      }
    }
  }
  return signal;
}

Picture bloom_over(Picture signal, double most, double bloom, double radius) {
  Picture excess = transform(signal, [&](double s) { return bloom * std::max(s - most, 0.0); });
  excess = apply(excess, gaussian_blur(excess.columns, radius), gaussian_blur(excess.rows, radius));
  return combine(std::move(signal), excess,
                 [&](double s, double halo) { return std::min(s, most) + halo; });
}

Picture limit_above(Picture signal, double most) {
  return transform(std::move(signal), [&](double s) { return std::min(s, most); });
}

double share_above(const Picture& signal, double most) {
  double all = 0.0, above = 0.0;
  for (const Plane& plane : signal.planes) {
    for (float value : plane) {
      const double s = static_cast<double>(value);
      all += s;
      above += std::max(s - most, 0.0);
    }
  }
  return all > 0.0 ? above / all : 0.0;
}

}  // namespace earthshine::degrade
