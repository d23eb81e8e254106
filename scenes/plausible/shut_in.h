// SPDX-License-Identifier: Apache-2.0
// Lamps and emitting objects whose light is enclosed: in a closed housing, behind a liner.
#pragma once

#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// One line for each lamp, and each emitting object,
//   of whose light more than 95 % ends on black backs, or
//   of whose light 10 % or more does and none, over six diffuse reflections, reaches a place
//   that a camera could see (without cameras: any front).
// cameras: of the call.
[[nodiscard]] std::vector<std::string> shut_in_lights(const Scene& scene, const RayQuery& query,
                                                      const std::vector<const Camera*>& cameras);

}  // namespace earthshine::scenes
