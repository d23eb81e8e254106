// SPDX-License-Identifier: Apache-2.0
// How unevenly light falls within a patch: what a patch of one radiosity cannot show.
//
// Illuminance is looked up at points of the patch, the direct part by shadow rays and the indirect
// part by gather rays that read a radiosity found before. Each look-up is done twice, with two sets
// of source points and directions; all points of the patch share the sets (common random numbers).
// The variance between points is the mean product of the two sets' deviations: noise that the sets
// do not share averages out to nothing instead of adding up, and a variance below the noise that it
// shows itself is taken as zero.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/direct/sources.h"
#include "radiosity/patches/refiner.h"
#include "radiosity/solution.h"

namespace earthshine::radiosity {

// A radiosity to read, per patch and light group, in units of the group's root mean square over all
// area: bright and faint groups count alike.
struct RelativeLight {
  const Patches* patches = nullptr;
  std::size_t groups = 0;
  std::vector<double> scale;      // per group: 1 / root mean square of its luminance; 0 if dark
  std::vector<float> brightness;  // patch * groups + group
  double area_m2 = 0.0;           // of all patches
};
[[nodiscard]] RelativeLight relative_light(const Solution& solution);

struct VariationOptions {
  // Of direct light, a patch gets 16 look-ups and one more for every square of this edge, so that a
  // spot of light on a large patch is found.
  double spacing_m = 0.1;
  int gather_directions = 32;  // per point and set, a multiple of 8
  std::uint64_t seed = 1;
};

class Variation {
 public:
  Variation(const scenes::World& world, const VariationOptions& options);

  // Per entry of `which`, patches of `patches`: (area / all area) * variance, mean over the light
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
