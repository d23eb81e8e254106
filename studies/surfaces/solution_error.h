// SPDX-License-Identifier: Apache-2.0
// What a radiosity solution is wrong by, over the surfaces themselves.
#pragma once

#include "studies/error/doubt.h"

namespace earthshine::studies {

// Relative to the mean radiosity of the surfaces.
struct SolutionError {
  Doubt form_factors;  // noise of the form factors' rays
  Doubt patches;       // one radiosity for a whole patch
  Doubt lamps;         // noise of the shadow rays by which patches see lamps, Sun and emitters
  Doubt solver;        // what the iteration left
  [[nodiscard]] Doubt total() const { return form_factors + patches + lamps + solver; }
};

}  // namespace earthshine::studies
