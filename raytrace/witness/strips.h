// SPDX-License-Identifier: Apache-2.0
// Strips of light or shadow thinner than a pixel, found along the edges that bound them.
#pragma once

#include <span>
#include <vector>

#include "raytrace/witness/edges.h"
#include "raytrace/witness/images.h"
#include "raytrace/witness/lit_spots.h"

namespace earthshine::raytrace {

// Strips of sources, direct and in flat mirrors, along the outlines of sources and of bodies in
// front of them.
void add_source_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots);

// Strips of light on visible surfaces, along the outlines that a small source sees, directly or by
// a flat mirror. lit: those on all surfaces, also hidden ones, no wider than tuning::wide_share of
// the scene's diagonal.
void add_light_strips(WitnessScene& scene, std::span<const SceneEdge> edges, SpotMap& spots,
                      std::vector<LitSpot>& lit);

}  // namespace earthshine::raytrace
