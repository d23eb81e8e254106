// SPDX-License-Identifier: Apache-2.0
#include "raytrace/surfaces/surface_refiner.h"

#include <algorithm>
#include <numeric>

namespace earthshine::raytrace {
namespace {

// Standard errors below which unevenness is noise. If one of n points is lit, the mean is one
// standard error.
constexpr double clear = 0.9;
// Few points miss much of the unevenness: the expected value has the weight of one more point.
constexpr double expected_points = 1.0;
constexpr float most_kept_rays = 0.5F;

}  // namespace

SurfaceRefiner::SurfaceRefiner(const radiosity::Patches& patches, double spot_m2)
    : Refiner(patches),
      spot_m2_(spot_m2),
      area_m2_(std::accumulate(patches.area_m2.begin(), patches.area_m2.end(), 0.0)),
      kept_rays_(patches.count(), most_kept_rays) {}

void SurfaceRefiner::see(const radiosity::Patches& patches, const SurfaceSamples& samples,
                         std::span<const std::uint32_t> which, std::span<const double> noise) {
  for (const std::uint32_t i : which) {
    const PatchResidual& r = samples.residual[i];
    radiosity::Unevenness& u = of(i);
    if (!noise.empty()) kept_rays_[i] = most_kept_rays;
    if (r.taken == 0 || patches.area_m2[i] <= spot_m2_) {
      u = {};
      continue;
    }
    const double own = r.taken / (r.taken + (is_expected_ ? expected_points : 0.0));
    u = {(1.0 - own) * u.error, 0.0, 0.0};
    const double within = double(r.square) - (noise.empty() ? double(r.mean_square) : noise[i]);
    if (within <= clear * double(r.square_error)) continue;
    const double part = own * double(r.open) * patches.area_m2[i] / area_m2_;
    // For the light of the parts, unevenness acts as noise does.
    if (!noise.empty()) {
      kept_rays_[i] = std::min(most_kept_rays, static_cast<float>(noise[i] / (noise[i] + within)));
    }
    u = {u.error + part * within, part * double(r.along_s), part * double(r.along_t)};
  }
  is_expected_ = true;
}

std::vector<std::uint32_t> SurfaceRefiner::follow(const radiosity::Patches& patches,
                                                  const std::vector<std::uint32_t>& parent) {
  std::vector<float> kept_rays(parent.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) kept_rays[i] = kept_rays_[parent[i]];
  std::vector<std::uint32_t> fresh = Refiner::follow(patches, parent);
  for (const std::uint32_t i : fresh) kept_rays[i] = most_kept_rays;
  kept_rays_ = std::move(kept_rays);
  return fresh;
}

}  // namespace earthshine::raytrace
