// SPDX-License-Identifier: Apache-2.0
// What a solution depends on, in parts that can be told apart: a stored one serves as long as all
// of them are the same. Cameras, CCTV, gather rays, the Phong lobe, names and the ambient term's
// radiance are in none: radiosity does not read them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// A digest of one part of the scene.
struct ScenePart {
  std::string key;    // its name in a file
  std::string words;  // what a message calls it
  std::uint64_t digest = 0;
};
// Geometry, materials (what they reflect and pass on), lights (lamps, emitting surfaces and how
// they are grouped), sky (Sun and Earth).
[[nodiscard]] std::vector<ScenePart> scene_parts(const scenes::Scene& scene,
                                                 const scenes::LightGroups& groups);

struct SolveKnob {
  std::string key;
  std::string words;  // how the user sets it
  std::variant<double, std::uint64_t> value;
};
[[nodiscard]] std::vector<SolveKnob> solve_knobs(const SolveOptions& options);

}  // namespace earthshine::radiosity
