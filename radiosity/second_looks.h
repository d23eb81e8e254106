// SPDX-License-Identifier: Apache-2.0
// The same scene solved again in other ways, each of which differs from the solution in one thing
// alone, so that what a picture owes to that thing can be seen in the picture itself.
#pragma once

#include <cstdint>
#include <functional>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

enum class Look {
  // On the solution's patches with a 32nd of its form-factor rays, and direct light from a
  // quarter of the points.
  FewRays,
  // The solution with the direct light of one of those, followed for one bounce.
  OtherDirect,
  // On other patches: of twice the edge with a sixteenth of the form-factor rays, or, of refined
  // ones and where faces cannot be made larger, each cut in four with a 32nd.
  OtherPatches
};
inline constexpr std::uint32_t few_rays_looks = 4, other_patches_looks = 2;

struct SecondLooks {
  // Form-factor rays per patch of FewRays over the solution's.
  double ray_share = 1.0;
  // Points on a patch to which direct light was found, over the solution's.
  double point_share = 1.0;
  // By how much the finer of the two cuts is better: the root of the share of patches, which is
  // the ratio of their edges and the first order in which piecewise constant radiosity converges.
  double error_ratio = 0.5;
  bool finer = false;  // the other patches are the finer ones
  std::size_t other_patches = 0;
  std::uint64_t rays = 0;
};

// Told of each as it is there: FewRays and OtherDirect few_rays_looks times, OtherPatches
// other_patches_looks times. Light groups are joined. `solution` has light in it.
using LookListener = std::function<void(Look look, const Solution& other)>;
SecondLooks look_again(const scenes::Scene& scene, const scenes::LightGroups& groups,
                       const scenes::Effects& effects, const scenes::RayQuery& query,
                       const SolveOptions& options, const Solution& solution,
                       const LookListener& listen);

}  // namespace earthshine::radiosity
