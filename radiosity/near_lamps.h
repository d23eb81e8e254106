// SPDX-License-Identifier: Apache-2.0
// Small patches where a lamp is near: half of the light of a lamp 1 mm off a wall falls on a spot
// of 3.5 mm, which a patch of 25 cm would spread over all of itself, and which rays that leave
// other surfaces would hardly ever meet.
#pragma once

#include "radiosity/patches/patches.h"
#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"

namespace earthshine::radiosity {

// Halves patches that lamps shine at until none is longer than its distance from the lamp, or than
// half of the lamp.
[[nodiscard]] Patches cut_near_lamps(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                     Patches patches);

}  // namespace earthshine::radiosity
