// SPDX-License-Identifier: Apache-2.0
// Light groups: sets of sources that are switched and dimmed together. Matrices and image layers
// have one column per (group, channel), in this order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

inline constexpr std::size_t no_group = static_cast<std::size_t>(-1);

// Contains only groups that give light: Sun and Earth if up and lit, lamps and emitting surfaces of
// non-zero power, and "ambient". index_of returns no_group for the others.
struct LightGroups {
  std::vector<std::string> names;
  std::size_t sun = no_group;
  std::size_t earth = no_group;      // the first of earth_parts() (sky_cells.h)
  std::size_t sun_parts = no_group;  // the first of SkyParts::suns
  std::size_t ambient = no_group;
  std::vector<std::size_t> lamp;      // per lamp of the scene
  std::vector<std::size_t> material;  // per material of the scene; no_group if unused

  [[nodiscard]] std::size_t count() const { return names.size(); }
};

[[nodiscard]] LightGroups find_light_groups(const Scene& scene);

}  // namespace earthshine::scenes
