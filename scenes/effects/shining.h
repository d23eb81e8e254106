// SPDX-License-Identifier: Apache-2.0
// The sources that shadow rays are aimed at, listed here and nowhere else: by the radiosity, which
// takes them with its patches, and by the renderer.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/effects/world.h"

namespace earthshine::scenes {

struct ShiningLight {
  enum class Kind { Sun, SunPart, Earth, Lamp, Emitter };
  Kind kind = Kind::Sun;
  std::size_t group = no_group;
  std::size_t index = 0;  // of the Sun among those of a sky in parts, the lamp or the material
};

// What the effects let shine, in Kind's order. The Earth also where escaping gather rays read it
// (Effects::earth_by_gather), and every emitting material, whether form factors carry it or not.
[[nodiscard]] std::vector<ShiningLight> shining_lights(const World& world);

}  // namespace earthshine::scenes
