// SPDX-License-Identifier: Apache-2.0
// Refiner for solutions with a sampled residual: the sum of all light, unscaled.
#pragma once

#include "radiosity/patches/refiner.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SurfaceRefiner : public radiosity::Refiner {
 public:
  // Patches up to this area are not divided (SurfaceLight).
  explicit SurfaceRefiner(const radiosity::Patches& patches, double spot_m2 = 0.0);

  // Takes samples of some patches; of all patches in the first call. noise: of the mean square of
  // r, from the light's own samples, per patch; empty: uses the squared mean of r in its place.
  void see(const radiosity::Patches& patches, const SurfaceSamples& samples,
           std::span<const std::uint32_t> which, std::span<const double> noise = {});
  std::vector<std::uint32_t> follow(const radiosity::Patches& patches,
                                    const std::vector<std::uint32_t>& parent);
  // Per patch, the fraction of its light's rays that its parts inherit.
  [[nodiscard]] std::span<const float> kept_rays() const { return kept_rays_; }

 private:
  double spot_m2_, area_m2_;
  std::vector<float> kept_rays_;
  bool is_expected_ = false;  // after the first samples
};

}  // namespace earthshine::raytrace
