// SPDX-License-Identifier: Apache-2.0
// Surfaces that are closed but for a hole that another surface stops up: a block without a bottom
// on a floor. Models leave out what nobody sees.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "radiosity/bodies/closed_parts.h"

namespace earthshine::radiosity {

// By part the triangles, three corners each, that close it: for open parts whose rim lies in one
// plane, of which the part itself sticks out, and all around, corners and middles of edges, on
// opaque one-sided triangles of other parts that face the hole, within a millionth of the scene's
// size.
[[nodiscard]] std::map<std::uint32_t, std::vector<Vec3>> find_stoppers(const scenes::Scene& scene,
                                                                       const ClosedParts& parts);

}  // namespace earthshine::radiosity
