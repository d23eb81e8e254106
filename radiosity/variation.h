// SPDX-License-Identifier: Apache-2.0
// Variation of light within a patch, which one radiosity per patch cannot represent.
//
// Illuminance is sampled at points of the patch: direct light by shadow rays, indirect light by
// gather rays that read an earlier radiosity. Each point has two sets of samples of sources and
// directions; all points of the patch share the sets (common random numbers). The variance between
// points is the mean product of the two sets' deviations, so that noise of separate sets averages
// out. A variance below its own noise counts as 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/direct/sources.h"
#include "radiosity/patches/refiner.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

// A radiosity per patch and light group, in units of the group's RMS over all area, so that bright
// and faint groups have equal weight.
struct RelativeLight {
  const Patches* patches = nullptr;
  std::size_t groups = 0;
  std::vector<double> scale;      // per group: 1 / RMS of its luminance; 0 if dark
  std::vector<float> brightness;  // patch * groups + group
  double area_m2 = 0.0;           // of all patches
};
[[nodiscard]] RelativeLight relative_light(const Solution& solution);

struct VariationOptions {
  // For direct light a patch has 16 sample points plus one per square of this edge, so that a spot
  // of light on a large patch is found.
  double spacing_m = 0.1;
  int gather_directions = 32;  // per point and set, a multiple of 8
  std::uint64_t seed = 1;
};

class Variation {
 public:
  Variation(const scenes::World& world, const VariationOptions& options);

  // Per entry of `which`, indices in `patches`: (area / all area) * variance, mean over the light
  // groups that are not dark.
  [[nodiscard]] std::vector<Unevenness> find(const Patches& patches,
                                             std::span<const std::uint32_t> which,
                                             const RelativeLight& light);
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  const scenes::World world_;
  std::vector<LightSource> sources_;
  std::size_t groups_, earth_group_;
  PatchAlbedos reflectances_;
  VariationOptions options_;
  std::uint64_t rays_ = 0;
};

}  // namespace earthshine::radiosity
