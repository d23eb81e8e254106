// SPDX-License-Identifier: Apache-2.0
// Lights that closed opaque walls hide from every camera.
//
// A closed surface S of triangles (every edge used equally often in both directions) has an integer
// winding number about each point off S, constant along every path that does not cross S. If it
// differs between a light and a camera, every path between them crosses S. Light travels in
// straight lines between surfaces and passes no face except glass: a front reflects it, a black
// back absorbs it. By induction over bounces light stays on its side of S, whatever else is there,
// including mirrors. The contribution of the light to the picture is exactly 0.
//
// Conservative conditions; otherwise the light stays on:
//   - S is opaque: sheets (two sides), glass and mirrors count as holes, although no light passes a
//     mirror, and a hole opens S
//   - vertices agree exactly, because rays do not slip through shared edges
//   - the lamp's and the lens's bounding balls, enlarged by the error of single precision, do not
//     meet S
//   - every camera has such a wall, of its own or shared
// The sky is at infinity, where every winding number is 0. Emitting surfaces are not tested: where
// they touch S their side is undefined.
#pragma once

#include <vector>

#include "scenes/effects/culling.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

// cameras: of the call; empty: all cameras of the scene. Throws base::Error (Work) if memory is
// insufficient.
[[nodiscard]] scenes::HiddenLights hidden_lights(const scenes::Scene& scene,
                                                 std::vector<const scenes::Camera*> cameras);

}  // namespace earthshine::radiosity
