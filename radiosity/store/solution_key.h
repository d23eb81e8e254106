// SPDX-License-Identifier: Apache-2.0
// Input of a solution, in separate parts: a stored solution is valid while all parts are equal.
// Cameras, CCTV, gather rays, the Phong lobe, names and the ambient term's radiance are excluded:
// the radiosity does not depend on them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// A digest of one part of the scene.
struct ScenePart {
  std::string key;    // name in the file
  std::string words;  // name in messages
  std::uint64_t digest = 0;
};
// Geometry, materials (reflection and transmission), lights (lamps, emitting surfaces and their
// grouping), sky (Sun and Earth).
[[nodiscard]] std::vector<ScenePart> scene_parts(const scenes::Scene& scene,
                                                 const scenes::LightGroups& groups);

struct SolveKnob {
  std::string key;
  std::string words;  // the user's name of the setting
  std::variant<double, std::uint64_t> value;
};
[[nodiscard]] std::vector<SolveKnob> solve_knobs(const SolveOptions& options);

}  // namespace earthshine::radiosity
