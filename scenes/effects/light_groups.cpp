// SPDX-License-Identifier: Apache-2.0
#include "scenes/effects/light_groups.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/sky/sky.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::scenes {

LightGroups find_light_groups(const Scene& scene) {
  LightGroups groups;
  const auto index_of = [&](const std::string& name) {
    const auto found = std::find(groups.names.begin(), groups.names.end(), name);
    if (found != groups.names.end()) {
      return static_cast<std::size_t>(found - groups.names.begin());
    }
    groups.names.push_back(name);
    return groups.names.size() - 1;
  };
  if (visible_sun_share(scene) > 0.0 && base::max_component(scene.sun->illuminance_lx) > 0.0) {
    groups.sun = index_of("sun");
  }
  if (earth_is_lit(scene)) {
    const std::size_t parts = earth_parts(scene);
    groups.earth = index_of(parts == 1 ? "earth" : "earth-0");
    for (std::size_t part = 1; part < parts; ++part) index_of(fmt::format("earth-{}", part));
  }
  if (scene.sky_parts && !scene.sky_parts->suns.empty()) {
    groups.sun_parts = index_of("sun-0");
    for (std::size_t k = 1; k < scene.sky_parts->suns.size(); ++k) {
      index_of(fmt::format("sun-{}", k));
    }
  }

  groups.lamp.assign(scene.lamps.size(), no_group);
  for (std::size_t k = 0; k < scene.lamps.size(); ++k) {
    const Lamp& lamp = scene.lamps[k];
    if (base::is_lit(lamp.strength())) {
      groups.lamp[k] = index_of(lamp.group);
    }
  }
  std::vector<bool> worn(scene.materials.size(), false);
  for (const Triangle& triangle : scene.triangles) worn[triangle.material] = true;
  groups.material.assign(scene.materials.size(), no_group);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (worn[m] && scene.materials[m].emits()) {
      groups.material[m] = index_of(scene.materials[m].light_group);
    }
  }
  if (base::max_component(scene.ambient_radiance) > 0.0) groups.ambient = index_of("ambient");
  return groups;
}

}  // namespace earthshine::scenes
