// SPDX-License-Identifier: Apache-2.0
// The radiosity of surfaces at points of them.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::validation {

// Points spread over the surfaces by area, sheets on both sides: `count` of them.
[[nodiscard]] std::vector<scenes::Hit> spread_over_surfaces(const scenes::Scene& scene,
                                                            std::size_t count, std::uint64_t seed);
// Luminance of the radiosity there, lm/m^2, interpolated as pictures read it.
[[nodiscard]] std::vector<double> radiosity_at(const scenes::RayQuery& query,
                                               const radiosity::Solution& solution,
                                               const std::vector<scenes::Hit>& where);

}  // namespace earthshine::validation
