// SPDX-License-Identifier: Apache-2.0
// Which emitting surfaces get shadow rays and which are carried by form factors: never both.
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace earthshine::radiosity {

// Per material of the scene. An emitter is sampled explicitly if it is small and bright, so that
// the few form-factor rays that find it bring much of the light:
// - its surfaces are less than a twentieth of all surface area, and
// - its exitance (luminance) is more than twice E = sum A M / sum A (1 - rho), the mean illuminance
//   if all that is emitted stayed among all surfaces until absorbed; rho is all that a material
//   sends on: diffuse, lobe, mirror, glass.
// Else F carries it: in rows that add up to 1, what does not stand out from its surroundings adds
// no noise. In a closed furnace, M = 1 - rho everywhere, E is 1 and nothing stands out: B = 1
// exactly. The only place where this is decided.
[[nodiscard]] std::vector<bool> emitter_is_explicit(const scenes::Scene& scene);

}  // namespace earthshine::radiosity
