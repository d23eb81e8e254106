// SPDX-License-Identifier: Apache-2.0
// Detects valid input that is almost certainly a mistake: light that is enclosed, a view that shows
// nothing, a number in the wrong unit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// How a call uses the scene.
struct SceneUse {
  std::vector<const Camera*> cameras;  // of the scene; empty: all of them
  bool lights = true;                  // false: the call does not use its light
  bool cameras_used = true;            // false: the call uses no view
  bool moves_along_orbit = false;      // Sun and Earth move
  bool shows_facts = false;            // the output lists which lights shine
};

// Of pixels that are not square within 1 %, which a CCTV chain shows as squares; fx, fy: of K.
[[nodiscard]] std::optional<std::string> non_square_pixels_warning(double fx, double fy);

// One line each, with a remedy; docs/scene-format.md lists them under "Warnings about likely
// mistakes". Casts 576 rays per camera, and up to 512 for each lamp and each emitting object;
// deterministic.
[[nodiscard]] std::vector<std::string> implausible_input(const Scene& scene, const RayQuery& query,
                                                         const SceneUse& use);

}  // namespace earthshine::scenes
