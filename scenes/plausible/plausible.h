// SPDX-License-Identifier: Apache-2.0
// Input that obeys every rule and is still surely a mistake: light that cannot get anywhere, a view
// that shows nothing, a number in the wrong unit.
#pragma once

#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// What a call does with the scene.
struct SceneUse {
  std::vector<const Camera*> cameras;  // of the scene; empty: all of them
  bool lights = true;                  // false: its light is not asked for
  bool cameras_used = true;            // false: nor is any view
  bool moves_along_orbit = false;      // Sun and Earth are put elsewhere
  bool shows_facts = false;            // of each light whether it shines: no need to say it twice
};

// One line each, with what to do; docs/scene-format.md lists them under "Warnings about likely
// mistakes". Casts 576 rays a camera, and up to 512 for each lamp and each emitting object; the
// same rays for the same scene.
[[nodiscard]] std::vector<std::string> implausible_input(const Scene& scene, const RayQuery& query,
                                                         const SceneUse& use);

}  // namespace earthshine::scenes
