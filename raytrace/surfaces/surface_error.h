// SPDX-License-Identifier: Apache-2.0
// The error of a radiosity solution over the surfaces themselves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/frame/error_estimate.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// What a radiosity solution is wrong by, over the surfaces themselves.

// Relative to the mean radiosity of the surfaces.
struct SolutionError {
  ErrorEstimate form_factors;  // noise of rays, and what none of them finds
  ErrorEstimate patches;       // one radiosity for a whole patch
  ErrorEstimate lamps;   // noise of the shadow rays by which patches see lamps, Sun and emitters
  ErrorEstimate solver;  // what the iteration left
  [[nodiscard]] ErrorEstimate total() const { return form_factors + patches + lamps + solver; }
};

struct SurfaceError {
  // Root mean square of the error of the radiosity (luminance, all light together), interpolated
  // between patches as pictures read it, over all area and relative to its mean. What is or should
  // be more than four times as bright counts in proportion (error_weight), and of a patch no larger
  // than a spot (SurfaceLight) the mean counts, as a pixel shows no more of it.
  SolutionError parts;
  double unweighted = 0.0;  // at points, each counted in full
  bool known = false;       // false where nothing is lit
  std::vector<std::string> not_captured;
  std::uint64_t rays = 0;
  double seconds = 0.0;
};

// By the residual of the solution (residual_error.h).
[[nodiscard]] SurfaceError surface_error(const scenes::World& scene,
                                         const radiosity::Solution& solution,
                                         const radiosity::SolveOptions& solver);

}  // namespace earthshine::raytrace
