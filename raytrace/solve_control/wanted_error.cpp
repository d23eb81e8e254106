// SPDX-License-Identifier: Apache-2.0
#include "raytrace/solve_control/wanted_error.h"

#include <algorithm>
#include <cmath>

namespace earthshine::raytrace {
namespace {

// Pictures add the residual, so that the solution affects only their cost. Measured on the payload
// bay and on models in sunlight (docs/accuracy.md): 16 rays per patch cost least at errors of 5 to
// 0.5 %, and patches of 1/48 of the scene's diagonal at 5 %, smaller by a third for smaller errors.
constexpr double measured_error = 0.05;
constexpr int rays_a_patch = 16;
// On an orbiter in sunlight, balancing energy to 1e-3 takes a third of the picture's time at an
// error of 5 % and half at 2 %, while the number of samples is the same without it.
constexpr double balance = 0.1;
// Rays per lamp, and points per patch for direct light. Few suffice, because pictures correct their
// errors. Compared with sixteen points, four points have 0.95 to 1.03 of the squared error times
// CPU time, and the solve takes a third less time by night.
constexpr int flux_rays = 1 << 12, direct_points = 4;
constexpr double most_ray_ratio = 8.0;    // passes with at least 1/8 of the rays so far count
constexpr double most_times_more = 16.0;  // the rays so far
constexpr double least_power = 0.05;      // of the rays: an error may seem to rise by chance
constexpr double least_fitted = 1e-3;     // least error in the fit, over the wanted error
constexpr double smallest_edge = 2.0 / 3.0, largest_edge = 2.0;  // over the edge for the measured
                                                                 // error

}  // namespace

std::string limit_name(Limit limit) {
  switch (limit) {
    case Limit::None:
      return "none";
    case Limit::Time:
      return "time";
    case Limit::Memory:
      return "memory";
    case Limit::Settings:
      return "settings";
    case Limit::Steps:
      return "steps";
    case Limit::Stopped:
      return "stopped";
    case Limit::Ledger:
      return "ledger";
    case Limit::Given:
      return "given";
  }
  return "";
}

bool is_far_off(const std::vector<PassError>& passes, double wanted) {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, fewest = 1.0;
  for (const PassError& pass : passes) {
    if (most_ray_ratio * pass.rays < passes.back().rays) continue;
    fewest = std::min(fewest, pass.rays / passes.back().rays);
    const double rays = std::log(pass.rays / passes.back().rays);
    const double error = std::log(std::max(pass.error, least_fitted * wanted));
    count += 1.0, x += rays, y += error, xx += rays * rays, xy += rays * error;
  }
  const double spread = count * xx - x * x;
  if (fewest > 0.5 || spread <= 0.0) return false;
  const double power = std::max((x * y - count * xy) / spread, least_power);
  const double now = std::exp((y + power * x) / count);
  return now > wanted * std::pow(most_times_more, power);
}

radiosity::SolveOptions picture_solver(const scenes::Scene& scene, const scenes::Quality& quality,
                                       std::uint64_t seed) {
  scenes::Quality usual = quality;
  usual.error.reset();
  scenes::QualityKnobs knobs = scenes::resolve_quality(scene, usual);
  if (quality.error && !quality.patch_edge_m && !quality.max_patches &&
      !quality.refine.value_or(false)) {
    const double ratio = *quality.error / measured_error;
    knobs.refine = false;
    knobs.patch_edge_m *= std::clamp(std::sqrt(ratio), smallest_edge, largest_edge);
  }
  if (quality.error && !quality.form_factor_rays) knobs.form_factor_rays = rays_a_patch;
  radiosity::SolveOptions options = radiosity::solve_options(knobs, seed);
  options.flux_rays = flux_rays;
  options.direct_points = direct_points;
  options.balance = balance;
  return options;
}

}  // namespace earthshine::raytrace
