// SPDX-License-Identifier: Apache-2.0
// A solution as coloured triangles for a 3D viewer: every patch side that gives or reflects light.
#pragma once

#include <vector>

#include "radiosity/solution.h"
#include "scenes/mesh/gltf/writer.h"

namespace earthshine::radiosity {

struct SolutionMesh {
  std::vector<scenes::GltfPart> parts;  // per object of the scene
  double lm_m2_per_unit = 0.0;          // a colour of 1 is this radiosity; 0 when there is no light
  double clipped_share = 0.0;           // of the area: brighter than 1 in some channel
};

// Colours are the radiosity of all light groups together, with the exitance of emitting surfaces,
// linear and clipped at 1. The unit makes the area-weighted log-mean luminance of what is lit
// (above 1e-5 of the brightest) middle grey, 0.18, or is larger, so that at most a twentieth of the
// area has a luminance above 1. At a corner the patches of one object and material that meet there
// at less than 40 degrees are averaged by area: curved and cut surfaces look smooth, edges stay
// sharp. Both sides of a sheet are there, each facing its own way.
[[nodiscard]] SolutionMesh solution_mesh(const scenes::Scene& scene, const Solution& solution);

}  // namespace earthshine::radiosity
