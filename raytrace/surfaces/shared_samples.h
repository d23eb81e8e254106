// SPDX-License-Identifier: Apache-2.0
// What cosine rays find at the patches of one coarse patch, shared between them: what they find in
// common is known by the rays of all, and of what each finds besides the share s / (s + q) is kept
// (Wiener), s the mean square of what differs, q that of its noise. Two halves of the rays tell
// both: the mean of their product has no noise.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/surfaces/surface_samples.h"

namespace earthshine::raytrace {

class SharedSamples {
 public:
  // coarse: the coarse patch of every patch. Of `which` those count that reflect: others were not
  // sampled.
  SharedSamples(const SurfaceLight& light, const radiosity::PatchAlbedos& reflectances,
                const SurfaceSamples& samples, std::span<const std::uint32_t> which,
                std::span<const SampleBudget> budget, std::span<const std::uint32_t> coarse);

  // So many rays of its own would tell as much of the patch.
  [[nodiscard]] double rays(std::uint32_t patch) const;
  // Of the rays that the light of a patch is known by, how many count where it is off by more than
  // its noise and that of the samples: the light about it has changed since.
  [[nodiscard]] double still_counting(std::uint32_t patch, double before) const;
  // change(patch, value): of each of `width` values, what the samples would change at the patch.
  // Returns per patch and value what is changed after sharing; 0 where nothing was sampled.
  [[nodiscard]] std::vector<double> share(
      std::size_t width,
      const std::function<double(std::uint32_t patch, std::size_t value)>& change) const;

 private:
  std::span<const std::uint32_t> which_, coarse_;
  std::vector<double> own_;          // per patch: its rays
  std::vector<double> all_;          // per coarse patch: the rays of all of its patches
  std::vector<double> kept_;         // per patch
  std::vector<double> noise_, off_;  // per patch, lx^2: of what was found; how far the light is off
};

}  // namespace earthshine::raytrace
