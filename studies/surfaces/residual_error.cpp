// SPDX-License-Identifier: Apache-2.0
#include "studies/surfaces/residual_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "raytrace/frame/frame.h"

namespace earthshine::studies {
namespace {

// Few patches hold much of the error: its mean is nearer to a lognormal than to a normal quantity.
constexpr double sure = 1.5 * 1.645;
constexpr double darkest = 0.02;  // of the mean that a solution has, that it should have

Rgb at(const std::vector<double>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

ErrorEstimate doubt_of(double square, double more) {
  return {std::sqrt(std::max(0.0, square)), std::sqrt(std::max(0.0, square) + std::max(0.0, more))};
}

}  // namespace

Effort effort_of(double rays) {
  constexpr double most = 1 << 16;
  const auto all = std::bit_floor(static_cast<std::uint32_t>(std::clamp(rays, 32.0, most)));
  const std::uint32_t each = std::clamp<std::uint32_t>(all / 4, 8, all < 512 ? 32 : 64);
  return {static_cast<std::uint16_t>(all / (2 * each)), static_cast<std::uint16_t>(each)};
}

std::vector<Effort> even_effort(const radiosity::Patches& patches, double points) {
  const double all = std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0);
  std::vector<Effort> effort;
  for (const double area : patches.area_m2) {
    effort.push_back(effort_of(16.0 * (2.0 + points * area / all)));
  }
  return effort;
}

std::vector<double> ray_variance(const radiosity::Patches& patches, const SurfaceSamples& samples,
                                 const std::vector<Effort>& effort) {
  std::vector<double> variance(effort.size(), 0.0);
  double mean = 0.0, area = 0.0;
  for (std::size_t i = 0; i < variance.size(); ++i) {
    const PatchResidual& r = samples.residual[i];
    variance[i] = r.mean_variance * 2.0 * r.taken * effort[i].rays;
    mean += patches.area_m2[i] * variance[i];
    area += patches.area_m2[i];
  }
  for (double& v : variance) v = 0.5 * (v + mean / area);
  return variance;
}

LightNoise noise_of(const LightOnSurfaces& light, const std::vector<double>& ray_variance,
                    const SurfaceSamples& samples) {
  LightNoise noise;
  for (std::uint32_t i = 0; i < ray_variance.size(); ++i) {
    const PatchResidual& r = samples.residual[i];
    noise.rays.push_back(ray_variance[i] / std::max(1.0, light.gather_rays(i)));
    noise.lamps.push_back(r.lamps_mean_variance * r.taken / std::max(1.0, light.lamp_points(i)));
  }
  return noise;
}

ResidualError residual_error(const LightOnSurfaces& light, const SurfaceSamples& samples,
                             const LightNoise& noise, const radiosity::PatchAlbedos& reflectances,
                             double mean, double solver_error) {
  ResidualError error;
  const radiosity::Patches& patches = light.patches();
  const std::size_t count = patches.count(), groups = light.light().columns() / 3;
  // Both halves at once, three columns each.
  std::vector<double> residual(count * 6, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      residual[i * 6 + k] = samples.residual[i].half[k / 3][static_cast<int>(k % 3)];
    }
  }
  const std::vector<double> brought = light.brought(residual, 6);
  double area = 0.0, square = 0.0, rays = 0.0, lamps = 0.0, variance = 0.0, excess = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const PatchResidual& r = samples.residual[i];
    if (r.taken == 0) continue;
    const double part = patches.area_m2[i] * r.taken / r.tried;  // what no body covers
    area += part;
    const Rgb rho = reflectances.of(patches, i);
    Rgb b(0.0);
    for (std::size_t g = 0; g < groups; ++g) {
      const float* own = &light.light().solution.radiosity[(i * groups + g) * 3];
      b += Rgb(own[0], own[1], own[2]);
    }
    const double weight =
        raytrace::error_weight(base::luminance(b + 0.5 * (r.half[0] + r.half[1])), mean);
    const std::size_t j = light.coarse(i) * std::size_t{6};
    const double ga = weight * base::luminance(rho * at(brought, j)),
                 gb = weight * base::luminance(rho * at(brought, j + 3));
    const double ra = weight * base::luminance(r.half[0]), rb = weight * base::luminance(r.half[1]);
    square += part * (r.square + ra * gb + rb * ga + ga * gb);
    rays += part * noise.rays[i];
    lamps += part * noise.lamps[i];
    variance += part * part * r.square_variance;
    excess += part * 0.5 * (ra + rb + ga + gb) / std::max(1e-3, weight);
  }
  const double seen = light.mean_radiosity();
  if (area <= 0.0 || seen <= 0.0) return error;
  error.mean = std::max(darkest * seen, seen + excess / area);
  const double unit = area * error.mean * error.mean;
  error.square = std::max(0.0, square / unit);
  error.doubt = std::sqrt(variance) / unit;
  // Where noise is less than expected, all of the error is noise.
  const double by_rays = std::min(error.square, rays / unit);
  const double by_lamps = std::min(error.square - by_rays, lamps / unit);
  error.patches = error.square - by_rays - by_lamps;
  error.parts.form_factors = doubt_of(by_rays, 0.5 * by_rays);
  error.parts.lamps = doubt_of(by_lamps, 0.5 * by_lamps);
  error.parts.patches = doubt_of(error.patches, 0.3 * error.patches + sure * error.doubt);
  error.parts.solver = {solver_error, solver_error};
  return error;
}

}  // namespace earthshine::studies
