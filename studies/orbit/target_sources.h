// SPDX-License-Identifier: Apache-2.0
// Which sources light a target, and how far, in one condition.
#pragma once

#include <cstddef>
#include <vector>

#include "studies/orbit/condition.h"

namespace earthshine::studies {

// Points of a target that shadow rays start from: a share is then known to 1 / sqrt(500) at worst.
inline constexpr std::size_t most_source_points = 500;
inline constexpr int earth_directions = 32;

// SourceOnTarget::off of what the setting has switched off.
inline constexpr const char* switched_off = "switched off";
// And of what it leaves less than this share of, with that share behind it.
inline constexpr double dimmed_share = 0.5;
inline constexpr const char* dimmed_to = "dimmed to ";

// Fills the target's `lamps`, `emitters` and `earth`: all shadow rays that serve every condition.
void reach_of_lamps(const LightBasis& basis, const scenes::RayQuery& query,
                    BasisView::Target& target);

struct TargetSources {
  std::vector<SourceOnTarget> sources;
  double lit_fraction = 0.0;
};
[[nodiscard]] TargetSources sources_on(const LightBasis& basis, const scenes::RayQuery& query,
                                       const BasisView::Target& target,
                                       const std::vector<bool>& straight_emitters,
                                       const GroupWeights& weights, const SkyPlace& sky);

// Share of the Sun's disc that the Earth leaves free; 0 without a Sun.
[[nodiscard]] double sun_share_of(const SkyPlace& sky);

}  // namespace earthshine::studies
