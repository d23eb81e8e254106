// SPDX-License-Identifier: Apache-2.0
// Inverse questions: the light that a target needs to be detected with a wanted probability, and
// the parts of the orbit where it is.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "studies/orbit/condition.h"

namespace earthshine::studies {

// Probability that each target of the view is detected, with the lamps of the setting times
// `lamps`; 0 without a probability and for hidden targets.
[[nodiscard]] std::vector<double> detections(const LightBasis& basis, const BasisView& view,
                                             std::size_t place, std::size_t setting, double lamps,
                                             const std::optional<degrade::Setup>& cctv,
                                             const SightOptions& options = {});

// Trial factors: from 2^-21 to 8 in steps of 4. Visibility need not increase with light, because a
// bright surround closes the iris.
inline constexpr double least_lamp_factor = 0x1p-21, most_lamp_factor = 8.0, lamp_factor_step = 4.0;

// The least factor with probability(factor) >= `wanted`, to 1 %: bisects below the first step that
// reaches it, but not below the least step. 0: reached without lamps; empty: reached at no step.
[[nodiscard]] std::optional<double> least_factor(const std::function<double(double)>& probability,
                                                 double wanted);

// Spans of the positions (rising, deg) where the probability is at least `wanted`. Spans end where
// linear interpolation between neighbouring positions crosses `wanted`. closed: the positions cover
// one orbit, and a span across 360 deg is one span.
using Arc = std::pair<double, double>;
[[nodiscard]] std::vector<Arc> arcs_above(const std::vector<double>& positions_deg,
                                          const std::vector<double>& probability, double wanted,
                                          bool closed);

// Sum of the arcs' lengths, deg.
[[nodiscard]] double total_deg(const std::vector<Arc>& arcs);

}  // namespace earthshine::studies
