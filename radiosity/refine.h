// SPDX-License-Identifier: Apache-2.0
// Patches where they matter: a coarse cut, solved cheaply, is cut further where light varies within
// a patch (variation.h): at the edges of shadows, under lamps, where surfaces meet.
#pragma once

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Patches that refinement may make: its budget, or what the coarse cut has if that is more.
[[nodiscard]] std::size_t most_refined_patches(const scenes::Scene& scene,
                                               const SolveOptions& options);

inline constexpr int most_refine_rounds = 24;

struct Refined {
  Patches patches;
  std::vector<RefineRound> rounds;
  std::uint64_t rays = 0;  // of all rounds
};

// subdivide(scene, options.patch_edge_m) where options.refine is off or nothing gives light. Else
// starts from cells of start_edge_m and cuts, round by round, the patches that hold half of the
// squared error, until options.refine is met, no error is left that is not noise or the rounds are
// over. What is cut depends on the scene, the options and the seed alone.
[[nodiscard]] Refined refine(const scenes::World& world, const SolveOptions& options);

}  // namespace earthshine::radiosity
