// SPDX-License-Identifier: Apache-2.0
// Radiosity at points on surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::validation {

// `count` points, uniform in area over all surfaces; sheets on both sides.
[[nodiscard]] std::vector<scenes::Hit> spread_over_surfaces(const scenes::Scene& scene,
                                                            std::size_t count, std::uint64_t seed);
// Luminance of the radiosity, lm/m^2, interpolated as in pictures.
[[nodiscard]] std::vector<double> radiosity_at(const scenes::RayQuery& query,
                                               const radiosity::Solution& solution,
                                               const std::vector<scenes::Hit>& where);

}  // namespace earthshine::validation
