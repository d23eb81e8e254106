// SPDX-License-Identifier: Apache-2.0
#include "degrade/parts/iris.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace earthshine::degrade {
namespace {

constexpr double peak_quantile = 0.995;
constexpr double normal_power = 4.0;

double gain_of_db(double db) { return std::pow(10.0, db / 20.0); }

double target_signal(const CctvCamera& camera) {
  if (camera.iris_target > 0.0) return camera.iris_target;
  switch (camera.iris) {
    case IrisMode::Normal:
      return 0.5;
    case IrisMode::Average:
      return 0.25;
    case IrisMode::Peak:
    case IrisMode::Fixed:
      break;
  }
  return 1.0;
}

// f-number one frame after `before`, on the way to `goal`.
double moved(const CctvCamera& camera, double before, double goal) {
  double stops = camera.iris_rate * 2.0 * std::log2(goal / before);
  if (camera.iris_slew > 0.0) stops = std::clamp(stops, -camera.iris_slew, camera.iris_slew);
  return std::clamp(before * std::exp2(stops / 2.0), camera.f_number_min, camera.f_number_max);
}

}  // namespace

double power_mean(const Plane& luminance, int columns, int rows, double p, double centre) {
  const double largest =
      std::max(0.0, static_cast<double>(*std::max_element(luminance.begin(), luminance.end())));
  if (largest == 0.0) return 0.0;
  const auto bell = [](int i, int n) {
    const double u = (2.0 * i + 1.0) / n - 1.0;
    return 1.0 - u * u;
  };
  // The usual fourth power, without std::pow().
  const auto raised = [p](double value) {
    const double squared = value * value;
    return p == 1.0 ? value : p == 4.0 ? squared * squared : std::pow(value, p);
  };
  double sum = 0.0, weights = 0.0;
  for (int y = 0; y < rows; ++y) {
    const double bell_y = bell(y, rows);
    for (int x = 0; x < columns; ++x) {
      const double weight = 1.0 - centre * (1.0 - bell(x, columns) * bell_y);
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(x);
      // Relative to the largest value, so that no power overflows.
      const double value = std::max(0.0, static_cast<double>(luminance[i])) / largest;
      sum += weight * raised(value);
      weights += weight;
    }
  }
  return largest * std::pow(sum / weights, 1.0 / p);
}

double quantile(Plane values, double q) {
  const double rank = q * static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(rank));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

double metered_luminance(const Picture& radiance, const CctvCamera& camera) {
  if (camera.iris == IrisMode::Fixed) return 0.0;
  const Plane luminance = luminance_plane(radiance);
  switch (camera.iris) {
    case IrisMode::Peak:
      return std::max(0.0, quantile(luminance, peak_quantile));
    case IrisMode::Normal:
      return power_mean(luminance, radiance.columns, radiance.rows, normal_power,
                        camera.iris_centre);
    case IrisMode::Average:
    case IrisMode::Fixed:
      break;
  }
  return power_mean(luminance, radiance.columns, radiance.rows, 1.0, 0.0);
}

double lens_transfer(const CctvCamera& camera, double f_number) {
  const double effective = f_number * (1.0 + camera.magnification);
  return base::pi * camera.transmittance / (4.0 * effective * effective);
}

Exposure expose(const CctvCamera& camera, double metered, std::optional<double> before) {
  Exposure exposure;
  exposure.metered = metered;
  if (camera.iris == IrisMode::Fixed) {
    exposure.f_number = camera.f_number;
    exposure.gain = gain_of_db(camera.gain_db);
    return exposure;
  }
  exposure.target = target_signal(camera);
  const double wanted_lux = exposure.target * camera.white_lux;
  const double ideal = std::sqrt(lens_transfer(camera, 1.0) * metered / wanted_lux);
  const double goal = std::clamp(ideal, camera.f_number_min, camera.f_number_max);
  exposure.f_number = before ? moved(camera, *before, goal) : goal;
  const double reached_lux = lens_transfer(camera, exposure.f_number) * metered;
  const double most = gain_of_db(camera.gain_max_db);
  // Relative margin: an iris within its range meets the target only to rounding.
  const bool too_dark = reached_lux < wanted_lux * (1.0 - 1e-9);
  exposure.gain = too_dark ? std::min(wanted_lux / reached_lux, most) : 1.0;
  exposure.moving = std::abs(exposure.f_number / goal - 1.0) > 0.01;
  exposure.underexposed =
      !exposure.moving && reached_lux * exposure.gain < wanted_lux * (1.0 - 1e-9);
  exposure.blown = !exposure.moving && reached_lux > wanted_lux * (1.0 + 1e-9);
  return exposure;
}

}  // namespace earthshine::degrade
