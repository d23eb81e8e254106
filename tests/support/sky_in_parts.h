// SPDX-License-Identifier: Apache-2.0
// The same sky as a whole and in parts, for comparison.
#pragma once

#include <memory>

#include "scenes/sky/sky_cells.h"

namespace earthshine::tests {

inline scenes::Earth even_earth(const Vec3& direction, double half_angle_deg, double radiance) {
  scenes::Earth earth;
  earth.model = scenes::EarthModel::Uniform;
  earth.direction = glm::normalize(direction);
  earth.half_angle_deg = half_angle_deg;
  earth.radiance = Rgb(radiance);
  return earth;
}

// Divides the scene's uniform Earth into about `wanted` cells; its Sun becomes the only Sun of the
// parts.
inline scenes::Scene in_parts(scenes::Scene scene, std::size_t wanted) {
  scenes::SkyParts parts;
  if (scene.sun) parts.suns.push_back(*scene.sun);
  scene.sun.reset();
  if (scene.earth) {
    parts.cells = scenes::cells_of_disc(scene.earth->direction,
                                        base::radians(scene.earth->half_angle_deg), wanted);
  }
  scene.sky_parts = std::make_shared<const scenes::SkyParts>(std::move(parts));
  return scene;
}

}  // namespace earthshine::tests
