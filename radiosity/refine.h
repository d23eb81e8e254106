// SPDX-License-Identifier: Apache-2.0
// Adaptive patches: solves a coarse division cheaply and divides it further where light varies
// within a patch (variation.h): at edges of shadows, under lamps, where surfaces meet.
#pragma once

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Limit of the number of patches: the budget, or the coarse division's number if larger.
[[nodiscard]] std::size_t most_refined_patches(const scenes::Scene& scene,
                                               const SolveOptions& options);

inline constexpr int most_refine_rounds = 24;

struct Refined {
  Patches patches;
  std::vector<RefineRound> rounds;
  std::uint64_t rays = 0;  // of all rounds
};

// subdivide(scene, options.patch_edge_m) if options.refine is off or there is no light. Otherwise
// starts from cells of start_edge_m and divides, round by round, the patches with half of the
// squared error, until options.refine is met, the remaining error is noise, or the rounds are over.
// The result depends on the scene, the options and the seed only.
[[nodiscard]] Refined refine(const scenes::World& world, const SolveOptions& options);

}  // namespace earthshine::radiosity
