// SPDX-License-Identifier: Apache-2.0
// Solves the radiosity to a wanted error over the surfaces, estimated from its residual.
#pragma once

#include "raytrace/frame/options.h"
#include "raytrace/solve_control/wanted_error.h"

namespace earthshine::raytrace {

// Whether the scene leaves the division into patches to this solver.
[[nodiscard]] bool cuts_surfaces(const scenes::Quality& given);

// Options of the first solve: coarse patches with few rays, unless the scene sets them.
[[nodiscard]] radiosity::SolveOptions first_surface_options(const scenes::Scene& scene,
                                                            double error, std::uint64_t seed);

inline constexpr std::size_t parts_of_a_pass = 1000;

// Solves once, with coarse patches and few rays. Then repeats passes until the stated error reaches
// the wanted one, or a limit ends them: sample the residual on all patches, state the error,
// correct the light (surface_light.h), divide the patches with most of the unevenness, and
// distribute rays where noise is largest. Values in the scene's quality stay fixed. `progress` gets
// the name of each stage; it may be empty. Its reports count parts of passes, the total as
// predicted.
[[nodiscard]] SteeredSolution reach_surfaces(const scenes::World& scene, const Wanted& wanted,
                                             std::uint64_t seed, const SolveListener& listen,
                                             const StageListener& progress = {});

}  // namespace earthshine::raytrace
