// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/quality.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scenes/triangle_point.h"

namespace earthshine::scenes {
namespace {

int power_of_two_at_least(double value, int low, int high) {
  const double clamped = std::clamp(std::ceil(value), double(low), double(high));
  return static_cast<int>(std::bit_ceil(static_cast<std::uint32_t>(clamped)));
}

}  // namespace

int camera_samples_for(double error) {
  return power_of_two_at_least(64.0 * std::pow(default_error / error, 4.0 / 3.0), 4, 1 << 10);
}

QualityKnobs resolve_quality(const Scene& scene) { return resolve_quality(scene, scene.quality); }

QualityKnobs resolve_quality(const Scene& scene, const Quality& given) {
  constexpr double reference_error = default_error;  // error at which the laws were measured
  const double ratio = reference_error / given.error.value_or(reference_error);
  QualityKnobs knobs;
  knobs.form_factor_rays = given.form_factor_rays.value_or(
      power_of_two_at_least(1024.0 * std::pow(ratio, 1.0 / 0.6), 64, 1 << 18));
  knobs.gather_rays =
      given.gather_rays.value_or(power_of_two_at_least(32.0 * ratio * ratio, 8, 1 << 16));
  knobs.camera_samples =
      given.camera_samples.value_or(camera_samples_for(given.error.value_or(reference_error)));
  knobs.denoise = given.denoise.value_or(true);
  if (!scene.vertices.empty()) {
    const double diagonal_m = box_around(scene.vertices).diagonal();
    knobs.patch_edge_m = diagonal_m / 48.0 / std::clamp(ratio, 0.25, 4.0);
    knobs.start_edge_m = diagonal_m / 8.0;
  }
  if (given.patch_edge_m) knobs.patch_edge_m = knobs.start_edge_m = *given.patch_edge_m;
  knobs.refine = given.refine.value_or(given.max_patches || !given.patch_edge_m);
  knobs.max_patches = given.max_patches.value_or(0);
  if (given.error || !given.max_patches) knobs.refine_error = 1.5 * reference_error / ratio;
  knobs.solver_tolerance = given.solver_tolerance.value_or(1e-8);
  return knobs;
}

}  // namespace earthshine::scenes
