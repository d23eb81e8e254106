// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/monitor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

constexpr int sinc_zeros = 8;
const double fwhm_per_sigma = 2.0 * std::sqrt(2.0 * std::log(2.0));

// Integral of sinc(x) sinc(x / 8) from 0 to x, x in zeros; Simpson's rule, 64 steps per zero.
double windowed_sinc_integral(double x) {
  const int steps = 2 * std::max(1, static_cast<int>(std::ceil(32.0 * x)));
  const double h = x / steps;
  double sum = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double weight = k == 0 || k == steps ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    sum += weight * base::sinc(k * h) * base::sinc(k * h / sinc_zeros);
  }
  return sum * h / 3.0;
}

double reach(Spread spread, double width) {
  switch (spread) {
    case Spread::Gaussian:
      return 6.5 * width / fwhm_per_sigma;
    case Spread::Triangle:
      return width;
    case Spread::Sinc:
      return sinc_zeros * width;
    case Spread::None:
      break;
  }
  return 0.0;
}

}  // namespace

bool is_used(const Monitor& monitor, std::string_view field) {
  return field != "spread_width" || monitor.spread != Spread::None;
}

Grid picture_grid(int width, int height, const Monitor& monitor) {
  const double aspect = static_cast<double>(width) / height;
  const auto rounded = [](double x, int most) {
    return std::clamp(static_cast<int>(std::lround(std::min(x, 1e6))), 1, most);
  };
  if (aspect * monitor.rows <= monitor.columns) {
    return {rounded(aspect * monitor.rows, monitor.columns), monitor.rows};
  }
  return {monitor.columns, rounded(monitor.columns / aspect, monitor.rows)};
}

double spread_integral(Spread spread, double width, double x) {
  switch (spread) {
    case Spread::Gaussian:
      return 0.5 * std::erfc(-x * fwhm_per_sigma / (width * std::numbers::sqrt2));
    case Spread::Triangle: {
      const double tail = std::max(0.0, 1.0 - std::abs(x) / width);
      return x < 0.0 ? 0.5 * tail * tail : 1.0 - 0.5 * tail * tail;
    }
    case Spread::Sinc: {
      static const double half = windowed_sinc_integral(sinc_zeros);
      const double zeros = std::min(std::abs(x) / width, static_cast<double>(sinc_zeros));
      return 0.5 + std::copysign(0.5 * windowed_sinc_integral(zeros) / half, x);
    }
    case Spread::None:
      break;
  }
  return x < 0.0 ? 0.0 : 1.0;
}

AxisMap spread_map(Spread spread, double width, int resels, int pixels_per_resel) {
  AxisMap map;
  map.in = resels;
  const double radius = reach(spread, width);
  std::vector<std::vector<double>> phases;
  std::vector<int> firsts;
  for (int phase = 0; phase < pixels_per_resel; ++phase) {
    const double x = (phase + 0.5) / pixels_per_resel;
    const int first = static_cast<int>(std::floor(x - radius));
    const int last = static_cast<int>(std::floor(x + radius));
    std::vector<double> weight;
    for (int j = first; j <= last; ++j) {
      weight.push_back(spread_integral(spread, width, x - j) -
                       spread_integral(spread, width, x - j - 1.0));
    }
    phases.push_back(std::move(weight));
    firsts.push_back(first);
  }
  for (int i = 0; i < resels; ++i) {
    for (std::size_t phase = 0; phase < phases.size(); ++phase) {
      add_output(map, i + firsts[phase], phases[phase]);
    }
  }
  return map;
}

Picture spread_on_screen(const Picture& light, const Monitor& monitor, double& negative_share) {
  const auto map = [&](int resels) {
    return spread_map(monitor.spread, monitor.spread_width, resels, monitor.pixels_per_resel);
  };
  Picture spread = apply(light, map(light.columns), map(light.rows));
  double positive = 0.0, negative = 0.0;
  for (Plane& plane : spread.planes) {
    for (float& value : plane) {
      (value < 0.0F ? negative : positive) += static_cast<double>(value);
      value = std::max(value, 0.0F);
    }
  }
  negative_share = negative < 0.0 && positive > 0.0 ? -negative / positive : 0.0;
  return spread;
}

double room_luminance(const Monitor& monitor) {
  return monitor.reflectance * monitor.room_illuminance / base::pi;
}

Picture add_light(Picture light, double veil) {
  return transform(std::move(light), [&](double i) { return i + veil; });
}

}  // namespace earthshine::degrade
