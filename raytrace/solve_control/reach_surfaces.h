// SPDX-License-Identifier: Apache-2.0
// A solution whose radiosity is as exact over the surfaces as wanted, by its residual.
#pragma once

#include "raytrace/frame/options.h"
#include "raytrace/solve_control/wanted_error.h"

namespace earthshine::raytrace {

// Whether the scene leaves the cut to it.
[[nodiscard]] bool cuts_surfaces(const scenes::Quality& given);

// What it begins with: a coarse cut with few rays, unless the scene names the cut or the rays.
[[nodiscard]] radiosity::SolveOptions first_surface_options(const scenes::Scene& scene,
                                                            double error, std::uint64_t seed);

// Solves once, on a coarse cut with few rays. Then, until the stated error is within the wanted
// one or a limit comes: samples the residual on all patches, states the error, puts it right
// (surface_light.h), halves the patches that hold most of what is uneven within them, and casts
// rays where noise is most of it. What the scene's quality names stays as it is. `progress` is
// told what is under way; it may be empty.
[[nodiscard]] SteeredSolution reach_surfaces(const scenes::World& scene, const Wanted& wanted,
                                             std::uint64_t seed, const SolveListener& listen,
                                             const StageListener& progress = {});

}  // namespace earthshine::raytrace
