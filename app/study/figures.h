// SPDX-License-Identifier: Apache-2.0
// Figures of what was found of a target, by member: columns of tables name them in their rows.
#pragma once

#include "app/study/results.h"

namespace earthshine::app {

using Figure = Number (*)(const TargetFindings&);

template <auto Member>
Number figure_of(const TargetFindings& found) {
  return found.*Member;
}
template <auto Member>
Number sight_of(const TargetFindings& found) {
  return found.sight.*Member;
}
template <auto Part, auto Member>
Number part_of_sight(const TargetFindings& found) {
  const auto& part = found.sight.*Part;
  return part ? Number((*part).*Member) : Number();
}
template <auto Member>
inline constexpr Figure chance_of = part_of_sight<&studies::Sight::probability, Member>;
template <auto Member>
inline constexpr Figure signal_of = part_of_sight<&studies::Sight::signal, Member>;
template <auto Member>
inline constexpr Figure monitor_of = part_of_sight<&studies::Sight::monitor, Member>;
template <auto Member>
inline constexpr Figure eye_of = part_of_sight<&studies::Sight::eye, Member>;
template <auto Member>
Number eye_chance_of(const TargetFindings& found) {
  const auto& eye = found.sight.eye;
  return eye && eye->probability ? Number((*eye->probability).*Member) : Number();
}

}  // namespace earthshine::app
