// SPDX-License-Identifier: Apache-2.0
// Small patches where a lamp is near: half of the light of a lamp 1 mm off a wall falls on a spot
// of 3.5 mm, which a patch of 25 cm would spread over all of itself, and which rays that leave
// other surfaces would hardly ever meet.
#pragma once

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// As subdivide(), and then halves patches that lamps shine at until none is longer than a
// quarter of its distance from the lamp's centre, or of half of the lamp, and none holds more than
// a 32nd of a narrow beam, by rays of its lamp past nothing; or until they are about twice as many.
// Dimmed lamps count like others: a sum of lamps' lights is that of the scene with all of
// them. Lamps without any light cost nothing.
[[nodiscard]] Patches subdivide_near_lamps(const scenes::Scene& scene, double edge_m);

// How many that makes. Beyond a million, where cutting takes seconds and memory, what they are at
// the least (count_patches()).
[[nodiscard]] std::size_t count_near_lamps(const scenes::Scene& scene, double edge_m);

}  // namespace earthshine::radiosity
