// SPDX-License-Identifier: Apache-2.0
// The error of a radiosity solution over the surfaces themselves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "studies/study.h"
#include "studies/surfaces/solution_error.h"

namespace earthshine::studies {

struct SurfaceError {
  // Root mean square of the error of the radiosity (luminance, all light together), interpolated
  // between patches as pictures read it, over all area and relative to its mean; what is more than
  // four times as bright counts in proportion (error_weight).
  SolutionError parts;
  bool known = false;  // false where nothing is lit
  std::vector<std::string> not_captured;
  std::uint64_t rays = 0;
  double seconds = 0.0;
};

// By the residual of the solution (residual_error.h).
[[nodiscard]] SurfaceError surface_error(const StudyScene& scene,
                                         const radiosity::Solution& solution,
                                         const radiosity::SolveOptions& solver);

}  // namespace earthshine::studies
