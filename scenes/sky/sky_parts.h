// SPDX-License-Identifier: Apache-2.0
// A sky in parts, each a light group of its own: any sky made of them, such as that of another
// place in the orbit, is then a weighted sum of what the parts give. No scene file has one; studies
// put it in the place of the Sun and the Earth.
#pragma once

#include <optional>
#include <vector>

#include "scenes/scene.h"
#include "scenes/sky/sky_cells.h"

namespace earthshine::scenes {

struct SkyParts {
  std::vector<Sun> suns;          // whole discs that no Earth hides; groups "sun-0", "sun-1", ...
  std::optional<SkyCells> cells;  // of Scene::earth, uniform; groups "earth-0", ...
};

// How many light groups stand for the Earth: one for each cell, else one.
[[nodiscard]] std::size_t earth_parts(const Scene& scene);
// Which of them a direction toward the Earth belongs to.
[[nodiscard]] std::size_t earth_part(const Scene& scene, const Vec3& direction);

// The number of the Sun whose disc a direction meets, among SkyParts::suns; none: their count.
[[nodiscard]] std::size_t sun_part(const Scene& scene, const Vec3& direction);

}  // namespace earthshine::scenes
