// SPDX-License-Identifier: Apache-2.0
// The sources that light a target in one condition, and the parts of it that they light.
#pragma once

#include <cstddef>
#include <vector>

#include "studies/orbit/condition.h"

namespace earthshine::studies {

// Points of a target with shadow rays: the standard error of a share is at most 0.5 / sqrt(500).
inline constexpr std::size_t most_source_points = 500;
inline constexpr int earth_directions = 32;

// SourceOnTarget::off of sources that the setting switches off.
inline constexpr const char* switched_off = "switched off";
// SourceOnTarget::off of sources that the setting dims below this share; the share follows the
// text.
inline constexpr double dimmed_share = 0.5;
inline constexpr const char* dimmed_to = "dimmed to ";

// Casts the shadow rays that all conditions share, and fills the target's `lamps`, `emitters` and
// `earth`.
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

// Share of the Sun's disc that the Earth does not cover; 0 without a Sun.
[[nodiscard]] double sun_share_of(const SkyPlace& sky);

}  // namespace earthshine::studies
