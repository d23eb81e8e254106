// SPDX-License-Identifier: Apache-2.0
// What reach_surfaces() begins with.
#include <algorithm>

#include "studies/steer/reach_surfaces.h"

namespace earthshine::studies {
namespace {

constexpr int coarse_rays = 64;
constexpr double coarse_error = 0.2;  // that the first cut is meant for

}  // namespace

bool cuts_surfaces(const scenes::Quality& given) {
  return !given.patch_edge_m && given.refine.value_or(true);
}

radiosity::SolveOptions first_surface_options(const scenes::Scene& scene, double error,
                                              std::uint64_t seed) {
  scenes::Quality quality = scene.quality;
  const bool cuts = cuts_surfaces(quality);
  quality.error = cuts ? std::max(coarse_error, error) : error;
  radiosity::SolveOptions options =
      radiosity::solve_options(scenes::resolve_quality(scene, quality), seed);
  if (cuts) options.patch_edge_m = options.refine.start_edge_m;
  if (!quality.form_factor_rays) options.form_factor_rays = coarse_rays;
  options.refine.on = false;
  return options;
}

}  // namespace earthshine::studies
