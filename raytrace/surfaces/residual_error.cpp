// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/residual_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/units.h"

namespace earthshine::raytrace {
namespace {

// A few patches hold much of the error: its mean is closer to lognormal than to normal.
constexpr double sure = 1.5 * 1.645;
constexpr std::size_t residual_columns = 6;  // three for each half of the samples
constexpr double darkest = 0.02;             // least true mean, relative to the solution's mean

Rgb at(const std::vector<double>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

ErrorEstimate estimate_of(double square, double more) {
  return {std::sqrt(std::max(0.0, square)), std::sqrt(std::max(0.0, square) + std::max(0.0, more))};
}

// Standard error of the product of two estimates of the same mean.
double product_error(double a, double b) {
  return 0.5 * std::abs(a - b) * (std::abs(a - b) + std::abs(a + b));
}

ResidualError error_of_all(const LightOnSurfaces& light, const SurfaceSamples& samples,
                           const LightNoise& noise, const radiosity::PatchAlbedos& reflectances,
                           double solver_error) {
  ResidualError error;
  const radiosity::Patches& patches = light.patches();
  const std::size_t count = patches.count();
  std::vector<double> residual(count * residual_columns, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < residual_columns; ++k) {
      residual[i * residual_columns + k] =
          double(samples.residual[i].half[k / 3][static_cast<int>(k % 3)]);
    }
  }
  const std::vector<double> brought = light.brought(std::move(residual), residual_columns);
  double area = 0.0, square = 0.0, rays = 0.0, lamps = 0.0, variance = 0.0, excess = 0.0,
         whole = 0.0, unweighted = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const PatchResidual& r = samples.residual[i];
    if (r.taken == 0) continue;
    const std::array<Rgb, 2> half = {Rgb(r.half[0]), Rgb(r.half[1])};
    const double part = patches.area_m2[i] * double(r.open);  // open area
    area += part;
    const Rgb rho = reflectances.of(patches, i);
    const double weight = double(r.weight);
    const std::size_t j = light.coarse(i) * residual_columns;
    const double ga = weight * base::luminance(rho * at(brought, j)),
                 gb = weight * base::luminance(rho * at(brought, j + 3));
    const double ra = weight * base::luminance(half[0]), rb = weight * base::luminance(half[1]);
    const double plain = 1.0 / std::max(1e-3, weight);
    unweighted += part * (double(r.unweighted) + plain * plain * (ra * gb + rb * ga + ga * gb));
    // For spots only the mean counts.
    const bool is_spot = light.is_spot(i);
    const double ma = double(r.mean[0]), mb = double(r.mean[1]);
    square += part * ((is_spot ? ma * mb : double(r.square)) + ra * gb + rb * ga + ga * gb);
    variance += base::squared(part * (is_spot ? product_error(ma, mb) : double(r.square_error)));
    whole += part * double(r.mean_square);
    rays += part * noise.rays[i];
    lamps += part * noise.lamps[i];
    excess += part * 0.5 * (ra + rb + ga + gb) / std::max(1e-3, weight);
  }
  const double seen = light.mean_radiosity();
  if (area <= 0.0 || seen <= 0.0) return error;
  error.mean = std::max(darkest * seen, seen + excess / area);
  const double unit = area * error.mean * error.mean;
  error.square = std::max(0.0, square / unit);
  error.standard_error = std::sqrt(variance) / unit;
  error.unweighted = std::sqrt(std::max(0.0, unweighted / unit));
  // Noise is at most the squared error of the patches' means: stratified points have less noise
  // than independent ones, for which it is computed.
  const double by_noise = std::clamp(whole / unit, 0.0, error.square);
  const double by_rays = std::min(by_noise, rays / unit);
  const double by_lamps = std::min(by_noise - by_rays, lamps / unit);
  error.patches = error.square - by_rays - by_lamps;
  error.parts.form_factors = estimate_of(by_rays, 0.5 * by_rays);
  error.parts.lamps = estimate_of(by_lamps, 0.5 * by_lamps);
  error.parts.patches =
      estimate_of(error.patches, 0.3 * error.patches + sure * error.standard_error);
  error.parts.solver = {solver_error, solver_error};
  return error;
}

}  // namespace

SampleBudget budget_of(double rays) {
  constexpr double most = 1 << 16;
  const auto all = std::bit_floor(static_cast<std::uint32_t>(std::clamp(rays, 128.0, most)));
  const std::uint32_t each = std::clamp<std::uint32_t>(all / 16, 8, 64);
  return {static_cast<std::uint16_t>(all / (2 * each)), static_cast<std::uint16_t>(each)};
}

std::vector<SampleBudget> even_budget(const LightOnSurfaces& light, double points) {
  const radiosity::Patches& patches = light.patches();
  const double all = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
  std::vector<SampleBudget> budget;
  for (std::uint32_t i = 0; i < patches.count(); ++i) {
    const double rays = 16.0 * (2.0 + points * patches.area_m2[i] / all);
    budget.push_back(budget_of(rays));
  }
  return budget;
}

std::vector<SampleBudget> budget_where_uneven(const radiosity::Patches& patches,
                                              std::span<const std::uint32_t> which,
                                              const SurfaceRefiner& choice, double points) {
  const double area = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
  const double uneven = std::max(1e-300, choice.total());
  std::vector<SampleBudget> budget;
  for (const std::uint32_t i : which) {
    const double share = patches.area_m2[i] / area + choice.of(i).error / uneven;
    budget.push_back(budget_of(16.0 * (2.0 + points * share)));
  }
  return budget;
}

std::vector<SampleBudget> shadow_budget(const radiosity::Patches& patches,
                                        std::span<const std::uint32_t> which, double points) {
  constexpr double least = 8.0, most = 4096.0;
  const double all = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
  std::vector<SampleBudget> budget;
  for (const std::uint32_t i : which) {
    const double wanted = std::min(least + points * patches.area_m2[i] / all, most);
    budget.push_back(
        {static_cast<std::uint16_t>(std::bit_floor(static_cast<std::uint32_t>(wanted))), 0});
  }
  return budget;
}

std::vector<SampleBudget> budget_for(const LightOnSurfaces& light,
                                     const std::vector<double>& variance,
                                     const std::vector<std::uint32_t>& parent, double target,
                                     double most, double points) {
  const std::vector<double>& area = light.patches().area_m2;
  double roots = 0.0, all = 0.0, wanted = 0.0;
  for (const double a : area) all += a;
  std::vector<double> rays(parent.size());
  for (std::size_t i = 0; i < parent.size(); ++i) {
    rays[i] = std::sqrt(area[i] / all * variance[parent[i]]);
    roots += rays[i];
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    rays[i] = std::max(0.0, rays[i] * roots / std::max(1e-300, target) - light.gather_rays(i));
    wanted += rays[i];
  }
  const double scale = std::min(1.0, most / std::max(1.0, wanted));
  std::vector<SampleBudget> next;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    next.push_back(budget_of(std::max(scale * rays[i], 16.0 * points * area[i] / all)));
  }
  return next;
}

std::vector<double> ray_variance(const radiosity::Patches& patches, const SurfaceSamples& samples,
                                 std::span<const std::uint32_t> which,
                                 std::span<const SampleBudget> budget) {
  std::vector<double> variance(patches.count(), 0.0);
  double mean = 0.0, area = 0.0;
  for (std::size_t n = 0; n < which.size(); ++n) {
    const std::uint32_t i = which[n];
    const PatchResidual& r = samples.residual[i];
    variance[i] = double(r.mean_variance) * 2.0 * r.taken * budget[n].rays;
    mean += patches.area_m2[i] * variance[i];
    area += patches.area_m2[i];
  }
  for (const std::uint32_t i : which) variance[i] = 0.5 * (variance[i] + mean / area);
  return variance;
}

std::vector<double> LightNoise::all() const {
  std::vector<double> sum(rays.size());
  std::transform(rays.begin(), rays.end(), lamps.begin(), sum.begin(), std::plus<>());
  return sum;
}

LightNoise noise_of(const LightOnSurfaces& light, const std::vector<double>& ray_variance,
                    const SurfaceSamples& samples) {
  LightNoise noise;
  for (std::uint32_t i = 0; i < ray_variance.size(); ++i) {
    const PatchResidual& r = samples.residual[i];
    noise.rays.push_back(ray_variance[i] / std::max(1.0, light.gather_rays(i)));
    // A new part of a divided patch has the lamps' light of its parent: its measured error counts.
    noise.lamps.push_back(light.lamp_rays(i) > 0.0
                              ? double(r.lamps_mean_variance) * r.taken *
                                    light.light().shadow_rays[i] / light.lamp_rays(i)
                              : std::max(0.0, double(r.lamps_mean_square)));
  }
  return noise;
}

ResidualError residual_error(const LightOnSurfaces& light, const SurfaceSamples& samples,
                             const LightNoise& noise, const radiosity::PatchAlbedos& reflectances,
                             double solver_error) {
  ResidualError error;
  if (light.shares().is_root()) {
    error = error_of_all(light, samples, noise, reflectances, solver_error);
  } else {
    (void)light.brought({}, residual_columns);
  }
  light.shares().broadcast(&error, 1);
  return error;
}

}  // namespace earthshine::raytrace
