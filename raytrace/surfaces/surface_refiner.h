// SPDX-License-Identifier: Apache-2.0
// The refiner of solutions whose residual is sampled: all light together, as it is.
#pragma once

#include "radiosity/patches/refiner.h"
#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SurfaceRefiner : public radiosity::Refiner {
 public:
  // spot_m2: no patch as small is cut (SurfaceLight).
  explicit SurfaceRefiner(const radiosity::Patches& patches, double spot_m2 = 0.0);

  // Takes samples of some patches, of all of them the first time. noise: of the mean square of r,
  // the light's own noise, per patch; empty: the mean square that patches are off by as a whole.
  void see(const radiosity::Patches& patches, const SurfaceSamples& samples,
           std::span<const std::uint32_t> which, std::span<const double> noise = {});
  std::vector<std::uint32_t> follow(const radiosity::Patches& patches,
                                    const std::vector<std::uint32_t>& parent);
  // Per patch, how far the rays that its light is known by count for its sub-patches.
  [[nodiscard]] std::span<const float> kept_rays() const { return kept_rays_; }

 private:
  double spot_m2_, area_m2_;
  std::vector<float> kept_rays_;
  bool is_expected_ = false;  // after the first samples
};

}  // namespace earthshine::raytrace
