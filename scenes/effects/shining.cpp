// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/shining.h"

#include "scenes/sky/sky_cells.h"

namespace earthshine::scenes {

std::vector<ShiningLight> shining_lights(const World& world) {
  using Kind = ShiningLight::Kind;
  const LightGroups& groups = world.groups;
  std::vector<ShiningLight> lights;
  if (world.effects.sun) lights.push_back({Kind::Sun, groups.sun});
  for (std::size_t k = 0; world.effects.sun_parts && k < world.scene.sky_parts->suns.size(); ++k) {
    lights.push_back({Kind::SunPart, groups.sun_parts + k, k});
  }
  if (world.effects.earth) lights.push_back({Kind::Earth, groups.earth});
  for (std::size_t k = 0; k < groups.lamp.size(); ++k) {
    if (groups.lamp[k] != no_group) lights.push_back({Kind::Lamp, groups.lamp[k], k});
  }
  for (std::size_t m = 0; m < groups.material.size(); ++m) {
    if (groups.material[m] != no_group) lights.push_back({Kind::Emitter, groups.material[m], m});
  }
  return lights;
}

}  // namespace earthshine::scenes
