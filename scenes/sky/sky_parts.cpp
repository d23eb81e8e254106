// SPDX-License-Identifier: Apache-2.0
#include "scenes/sky/sky_parts.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {

std::size_t earth_parts(const Scene& scene) {
  return scene.sky_parts && scene.sky_parts->cells ? scene.sky_parts->cells->count() : 1;
}

std::size_t earth_part(const Scene& scene, const Vec3& direction) {
  return scene.sky_parts && scene.sky_parts->cells ? scene.sky_parts->cells->cell_of(direction) : 0;
}

std::size_t sun_part(const Scene& scene, const Vec3& direction) {
  if (!scene.sky_parts) return 0;
  const std::vector<Sun>& suns = scene.sky_parts->suns;
  const auto met = std::find_if(suns.begin(), suns.end(), [&](const Sun& sun) {
    return glm::dot(direction, sun.direction) >= std::cos(base::radians(sun.angular_radius_deg));
  });
  return static_cast<std::size_t>(met - suns.begin());
}

}  // namespace earthshine::scenes
