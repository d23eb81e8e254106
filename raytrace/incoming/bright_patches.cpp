// SPDX-License-Identifier: Apache-2.0
#include "raytrace/incoming/bright_patches.h"

#include <algorithm>
#include <cmath>

namespace earthshine::raytrace {
namespace {

constexpr double bright_ratio = 16.0;

}  // namespace

BrightPatches::BrightPatches(const radiosity::Solution& solution) : source_(&solution.patches) {
  const std::size_t count = solution.patches.count();
  if (solution.radiosity.empty()) return;
  std::vector<double> luminance(count, 0.0);
  double flux = 0.0, area = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < solution.columns; k += 3) {
      const float* b = &solution.radiosity[i * solution.columns + k];
      luminance[i] += base::luminance({b[0], b[1], b[2]});
    }
    flux += luminance[i] * solution.patches.area_m2[i];
    area += solution.patches.area_m2[i];
  }
  double sum = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (luminance[i] * area <= bright_ratio * flux) continue;
    patches_.push_back(i);
    sum += luminance[i] * solution.patches.area_m2[i];
    cumulative_.push_back(sum);
  }
  if (patches_.empty()) return;
  density_per_m2_.assign(count, 0.0F);
  for (double& c : cumulative_) c /= sum;
  for (const std::uint32_t i : patches_) {
    density_per_m2_[i] = static_cast<float>(luminance[i] / sum);
  }
}

BrightPatches::Aim BrightPatches::aim(double choice, double x, double y) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, choice);
  const std::uint32_t patch = patches_[static_cast<std::size_t>(found - cumulative_.begin())];
  const radiosity::SurfacePoint at = source_->at(patch, x, y);
  const std::uint32_t triangle =
      source_->is_several(patch) ? source_->on_triangle(patch, x, y).triangle : scenes::no_triangle;
  return {patch, triangle, at.position, at.normal};
}

double BrightPatches::density_per_sr(std::uint32_t patch, double distance_m,
                                     double cosine_at_patch) const {
  const double per_m2 = density_per_m2_[patch];
  if (per_m2 == 0.0) return 0.0;
  return per_m2 * distance_m * distance_m / std::max(std::abs(cosine_at_patch), 1e-9);
}

}  // namespace earthshine::raytrace
