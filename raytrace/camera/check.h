// SPDX-License-Identifier: Apache-2.0
// Is the camera somewhere from which there is something to see?
#pragma once

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::raytrace {

// How often the surface of an object winds around a point, counting its opaque one-sided triangles:
// 1 inside a closed body, 0 outside it, -1 inside a closed room (fronts inward), between them for
// open surfaces. The sum of signed solid angles over 4 pi (van Oosterom and Strackee 1983,
// equation 8), so that it needs no ray and no tolerance.
[[nodiscard]] double winding_number(const scenes::Scene& scene, std::uint32_t object,
                                    const Vec3& point);

// Throws base::Error (Input), at the camera's place in the scene file and naming the object, if the
// camera stands inside a body whose backs are black:
//   every ray from it meets the back of an opaque one-sided surface first, or
//   one closed object winds around it and at least half of its rays meet that object's back first.
// A closed room (fronts inward, or two-sided walls), a hull with a lining, an open bay and the
// inside of glass are all places to look from. The rays go to fixed directions over the sphere.
void check_camera(const scenes::Scene& scene, const scenes::RayQuery& query,
                  const scenes::Camera& camera);

}  // namespace earthshine::raytrace
