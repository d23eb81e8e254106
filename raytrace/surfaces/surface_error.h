// SPDX-License-Identifier: Apache-2.0
// The error of a radiosity solution over the surfaces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/error_estimate.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// Parts of the error, relative to the mean radiosity of the surfaces.
struct SolutionError {
  ErrorEstimate form_factors;  // noise of rays, and light that they miss
  ErrorEstimate patches;       // constant radiosity within a patch
  ErrorEstimate lamps;         // noise of shadow rays to lamps, Sun and emitters
  ErrorEstimate solver;        // remaining error of the iteration
  [[nodiscard]] ErrorEstimate total() const { return form_factors + patches + lamps + solver; }
};

struct SurfaceError {
  // RMS error of the radiosity (luminance, sum of all light), interpolated between patches as in
  // pictures, over all area and relative to its mean. Points that are, or should be, more than four
  // times as bright as the mean have reduced weight (error_weight). For patches no larger than a
  // spot (SurfaceLight), the error of the mean counts, because a pixel does not resolve them.
  SolutionError parts;
  double unweighted = 0.0;  // at points, without error_weight
  bool known = false;       // false if all is dark
  std::vector<std::string> not_captured;
  std::uint64_t rays = 0;
  double seconds = 0.0;
};

// From the residual of the solution (residual_error.h).
[[nodiscard]] SurfaceError surface_error(const scenes::World& scene,
                                         const radiosity::Solution& solution,
                                         const radiosity::SolveOptions& solver);

}  // namespace earthshine::raytrace
