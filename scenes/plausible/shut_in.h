// SPDX-License-Identifier: Apache-2.0
// Lamps and emitting objects whose light gets nowhere: in a closed housing, behind a liner.
#pragma once

#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// A line for each lamp, and each object that emits,
//   of whose light more than 95 % ends on black backs, or
//   of whose light 10 % or more does and none, over six diffuse reflections, comes to a place that
//   a camera could see (where there is no camera: to any front).
// cameras: those of the call.
[[nodiscard]] std::vector<std::string> shut_in_lights(const Scene& scene, const RayQuery& query,
                                                      const std::vector<const Camera*>& cameras);

}  // namespace earthshine::scenes
