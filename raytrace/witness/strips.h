// SPDX-License-Identifier: Apache-2.0
// Strips of light, or of shadow, thinner than a pixel, found along the edges that bound them.
#pragma once

#include <span>

#include "raytrace/witness/edges.h"
#include "raytrace/witness/images.h"

namespace earthshine::raytrace {

// Along the outlines that the camera sees before and of sources: strips of these, straight and in
// flat mirrors.
void add_source_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots);

// Along the outlines that a source of small extent sees, or its image in a flat mirror: strips of
// its light on surfaces in view.
void add_light_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots);

}  // namespace earthshine::raytrace
