// SPDX-License-Identifier: Apache-2.0
// A solution as coloured triangles for a 3D viewer: every patch side that emits or reflects light.
#pragma once

#include <vector>

#include "radiosity/solution.h"
#include "scenes/mesh/gltf/writer.h"

namespace earthshine::radiosity {

struct SolutionMesh {
  std::vector<scenes::GltfPart> parts;  // per object of the scene
  double lm_m2_per_unit = 0.0;          // radiosity of a colour of 1; 0 without light
  double clipped_share = 0.0;           // share of the area brighter than 1 in some channel
};

// Colours are the total radiosity of all light groups, including the exitance of emitting surfaces,
// linear and clipped at 1. The unit displays the area-weighted log-mean luminance of lit surfaces
// (above 1e-5 of the brightest) as middle grey, 0.18, or is larger, so that at most a twentieth of
// the area has a luminance above 1. At corners, patches of one object and material that meet at
// less than 40 degrees are averaged by area: curved and divided surfaces look smooth, edges stay
// sharp. A sheet has separate triangles for its two sides.
[[nodiscard]] SolutionMesh solution_mesh(const scenes::Scene& scene, const Solution& solution);

}  // namespace earthshine::radiosity
