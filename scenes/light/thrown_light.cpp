// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/thrown_light.h"

namespace earthshine::scenes {

LightSample thrown(const LightSample& sample, const FlatMirror& mirror, std::uint32_t number,
                   const Vec3& point) {
  const double height = mirror.height_m(point);
  const double rise = glm::dot(sample.direction, mirror.normal);
  if (height <= 0.0 || rise <= 0.0) return {};
  const double to_mirror = height / rise;
  if (to_mirror >= sample.distance_m) return {};  // the source is behind it
  const Vec3 from_centre = mirror.image(point) + to_mirror * sample.direction - mirror.centre;
  if (glm::dot(from_centre, from_centre) > mirror.radius_m * mirror.radius_m * (1.0 + 1e-9)) {
    return {};
  }
  return {mirror.turned(sample.direction), sample.distance_m, sample.normal_illuminance_lx, number};
}

}  // namespace earthshine::scenes
