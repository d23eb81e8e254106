// SPDX-License-Identifier: Apache-2.0
#include "raytrace/share/isolated.h"

namespace earthshine::raytrace {
namespace {

// Over a region's points with samples: the noise of one sample is the sum of the noise over the sum
// of 1 / n. Noisy points have more samples; with these sums, the predicted noise of the points adds
// up to their measured noise.
struct Around {
  double noise = 0.0, per_sample = 0.0;
};

}  // namespace

void regularise_isolated_variance(const Neighbours& neighbours, const Window& window,
                                  std::span<const OffGridPoint> off_grid_points,
                                  const Estimate& estimate, Shared& shared) {
  const std::size_t grid = neighbours.count(), points = estimate.samples.size();
  const auto columns = static_cast<std::size_t>(window.columns);
  const auto at = [&](std::size_t p) {
    return p < grid ? region_of(p, columns) : off_grid_points[p - grid].region;
  };
  const auto stands_alone = [&](std::size_t p) {
    if (p < grid) return neighbours.is_alone(p);
    return shared.inverse_dof[0][p] <= 0.0F;  // points with a base or mirror neighbours have 1 / N
  };
  std::vector<Around> regions(region_of(window.pixel_count() - 1, columns) + 1U);
  for (std::size_t p = 0; p < points; ++p) {
    if (estimate.samples[p] <= 0.0F) continue;
    Around& region = regions[at(p)];
    region.noise += double(estimate.noise(p));
    region.per_sample += 1.0 / double(estimate.samples[p]);
  }
  shared.variance_prior.assign(points, 0.0F);
  for (std::size_t p = 0; p < points; ++p) {
    if (estimate.samples[p] <= 0.0F || !stands_alone(p)) continue;
    const Around& region = regions[at(p)];
    const double of_as_many = region.noise / region.per_sample / double(estimate.samples[p]);
    shared.variance_prior[p] = static_cast<float>(0.5 * (of_as_many - double(estimate.noise(p))));
  }
}

}  // namespace earthshine::raytrace
