// SPDX-License-Identifier: Apache-2.0
// Shares the illuminance from cosine rays between the patches of one coarse patch. All of their
// rays estimate the common mean; each patch keeps the share s / (s + q) (Wiener gain) of its
// difference from it, s the mean square of the differences, q of their noise. The product of two
// halves of the rays estimates s without bias by noise.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SharedSamples {
 public:
  // coarse: the coarse patch of every patch. Black patches of `which` were not sampled and are
  // ignored.
  SharedSamples(const SurfaceLight& light, const radiosity::PatchAlbedos& reflectances,
                const SurfaceSamples& samples, std::span<const std::uint32_t> which,
                std::span<const SampleBudget> budget, std::span<const std::uint32_t> coarse);

  // Number of own rays with the same variance as the shared estimate.
  [[nodiscard]] double rays(std::uint32_t patch) const;
  // How many of the `before` rays in a patch's light still count. Fewer if the light differs from
  // the samples by more than their noise, because the light around the patch has changed.
  [[nodiscard]] double still_counting(std::uint32_t patch, double before) const;
  // change(patch, value): change of each of `width` values of a patch according to the samples.
  // Returns the change after sharing, per patch and value; 0 without samples.
  [[nodiscard]] std::vector<double> share(
      std::size_t width,
      const std::function<double(std::uint32_t patch, std::size_t value)>& change) const;

 private:
  std::span<const std::uint32_t> which_, coarse_;
  std::vector<double> own_;          // rays per patch
  std::vector<double> all_;          // rays per coarse patch
  std::vector<double> kept_;         // Wiener gain per patch
  std::vector<double> noise_, off_;  // per patch, lx^2: noise of the samples; squared change
};

}  // namespace earthshine::raytrace
