// SPDX-License-Identifier: Apache-2.0
// Small patches near lamps. Half of the light of a lamp 1 mm off a wall falls on a spot of 3.5 mm.
// A patch of 25 cm would spread it over its whole area, and rays from other surfaces would rarely
// hit it.
#pragma once

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// subdivide(), then halves patches lit by lamps until none is longer than a quarter of its distance
// from the lamp (or of the lamp's half size, if that is larger). Also halves them until none
// receives more than a 32nd of a narrow beam, counted by unoccluded rays. Ends when their number
// has about doubled. Dimmed lamps count fully, so that sums of lamps' layers agree with the scene
// with all lamps. Lamps without light have no effect.
[[nodiscard]] Patches subdivide_near_lamps(const scenes::Scene& scene, double edge_m);

// Number of resulting patches. Above a million, where dividing takes seconds and memory, the lower
// bound count_patches().
[[nodiscard]] std::size_t count_near_lamps(const scenes::Scene& scene, double edge_m);

}  // namespace earthshine::radiosity
