// SPDX-License-Identifier: Apache-2.0
// Lights that closed opaque walls keep from every camera.
//
// A closed surface S of triangles (every edge used equally often both ways) winds a whole number of
// times around a point that is not on it, and the same number of times around all points that a
// path joins which does not meet S: the winding number changes only across S. So where it differs
// between a light and a camera, every path between them meets S.
// Light goes straight from surface to surface, and no way of it leads through a face that is not
// glass: what meets a front goes on from the front, what meets a black back ends. By induction over
// its bounces light stays on the side of S where it started, whatever else stands there, mirrors
// included, and the camera is on the other: the light's part of the picture is 0, not just small.
//
// Left in doubt, the light stays on:
//   - S must be opaque: sheets (two sides), glass and mirrors are taken for holes, although no
//   light
//     passes a mirror, and a hole opens S
//   - corners must agree to the last bit, as rays do not slip through edges that two triangles
//   share
//   - the whole lamp and the whole lens must lie on their side, and further from S than single
//     precision is off: the ball around them must not meet S
//   - each camera must have such a wall of its own or shared
// The sky is at infinity, where every winding number is 0. Emitting surfaces are not looked at:
// where they touch S their side is undecided.
#pragma once

#include <vector>

#include "scenes/effects/culling.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

// cameras: those of the call; empty: all of the scene's. Throws base::Error (Work) where memory
// does not hold it.
[[nodiscard]] scenes::HiddenLights hidden_lights(const scenes::Scene& scene,
                                                 std::vector<const scenes::Camera*> cameras);

}  // namespace earthshine::radiosity
