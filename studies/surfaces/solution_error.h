// SPDX-License-Identifier: Apache-2.0
// What a radiosity solution is wrong by, over the surfaces themselves.
#pragma once

#include "studies/error/error_estimate.h"

namespace earthshine::studies {

// Relative to the mean radiosity of the surfaces.
struct SolutionError {
  ErrorEstimate form_factors;  // noise of the form factors' rays
  ErrorEstimate patches;       // one radiosity for a whole patch
  ErrorEstimate lamps;   // noise of the shadow rays by which patches see lamps, Sun and emitters
  ErrorEstimate solver;  // what the iteration left
  [[nodiscard]] ErrorEstimate total() const { return form_factors + patches + lamps + solver; }
};

}  // namespace earthshine::studies
