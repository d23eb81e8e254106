// SPDX-License-Identifier: Apache-2.0
// The sources that shadow rays are aimed at. The only list of them, for the radiosity, which
// creates them together with its patches, and for the renderer.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/effects/world.h"

namespace earthshine::scenes {

struct ShiningLight {
  enum class Kind { Sun, SunPart, Earth, Lamp, Emitter };
  Kind kind = Kind::Sun;
  std::size_t group = no_group;
  std::size_t index = 0;  // of the Sun in SkyParts, the lamp or the material
};

// Sources enabled by the effects, in Kind's order. Includes the Earth if escaping gather rays read
// it (Effects::earth_by_gather), and every emitting material, with or without form factors.
[[nodiscard]] std::vector<ShiningLight> shining_lights(const World& world);

}  // namespace earthshine::scenes
