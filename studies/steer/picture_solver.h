// SPDX-License-Identifier: Apache-2.0
// The solve for pictures of a wanted error. Pictures measure what a solution lacks and add it, so
// that the solution decides about their price alone: it need not be exact, only near.
#pragma once

#include "radiosity/solution.h"
#include "scenes/scene.h"

namespace earthshine::studies {

// Even patches and rays that cost about as much as they save the picture; what `quality` names
// itself stays as it is.
[[nodiscard]] radiosity::SolveOptions picture_solver(const scenes::Scene& scene,
                                                     const scenes::Quality& quality,
                                                     std::uint64_t seed);

}  // namespace earthshine::studies
