// SPDX-License-Identifier: Apache-2.0
// Questions asked backwards: how much light a target needs to be detected with a wanted
// probability, and along which parts of the orbit it is.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "studies/orbit/condition.h"

namespace earthshine::studies {

// Probability that each target of the view is detected; 0 where nothing of it can be told and where
// it counts as hidden. The lamps of the setting times `lamps`.
[[nodiscard]] std::vector<double> detections(const LightBasis& basis, const BasisView& view,
                                             std::size_t place, std::size_t setting, double lamps,
                                             const std::optional<degrade::Setup>& cctv,
                                             const SightOptions& options = {});

// Factors that are tried: from 2^-21 to 8 by steps of 4. More light need not be better: a bright
// surround closes the iris.
inline constexpr double least_lamp_factor = 0x1p-21, most_lamp_factor = 8.0, lamp_factor_step = 4.0;

// The least factor at which probability(factor) reaches `wanted`, to a hundredth of itself: the
// first step that does, halved down, but no less than the first step. 0: it does without any; none:
// it does at no step.
[[nodiscard]] std::optional<double> least_factor(const std::function<double(double)>& probability,
                                                 double wanted);

// Spans of the positions (rising, deg) at which the probability is `wanted` or more: from the first
// to the last position of each, or where it crosses `wanted` between two neighbours, taken as
// straight. closed: the positions go once around, and a span over 360 deg is one.
using Arc = std::pair<double, double>;
[[nodiscard]] std::vector<Arc> arcs_above(const std::vector<double>& positions_deg,
                                          const std::vector<double>& probability, double wanted,
                                          bool closed);

// Sum of the arcs' lengths, deg.
[[nodiscard]] double total_deg(const std::vector<Arc>& arcs);

}  // namespace earthshine::studies
