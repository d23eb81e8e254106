// SPDX-License-Identifier: Apache-2.0
// Many lamps of one light group as one source, whose cost at a patch does not grow with their
// number: those that matter there get shadow rays, and some of the others by chance
// (scenes/light/light_tree.h).
#pragma once

#include <vector>

#include "radiosity/direct/sources.h"

namespace earthshine::radiosity {

// Fewer lamps of a group are sources of their own, sampled everywhere and each in the ledger.
inline constexpr std::size_t fewest_in_cluster = 33;

// lamps: indices in the scene, which must outlive the source.
[[nodiscard]] LightSource cluster_source(const scenes::Scene& scene,
                                         const std::vector<std::size_t>& lamps, std::uint64_t key,
                                         std::size_t group, int points);

}  // namespace earthshine::radiosity
