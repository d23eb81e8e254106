// SPDX-License-Identifier: Apache-2.0
#include "scenes/specular.h"

#include <algorithm>
#include <cmath>

namespace earthshine::scenes {

bool any_passes_light_on(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.passes_light_on(); });
}

Refraction refract(const Material& material, const Vec3& normal, const Vec3& direction) {
  if (material.two_sided) return {direction, false};
  const bool entering = glm::dot(direction, normal) < 0.0;
  const Vec3 facing = entering ? normal : -normal;
  const double ratio = entering ? 1.0 / material.ior : material.ior;
  const double cosine = -glm::dot(direction, facing);
  const double sine2 = ratio * ratio * (1.0 - cosine * cosine);
  if (sine2 >= 1.0) return {glm::reflect(direction, facing), true};
  return {glm::normalize(ratio * direction + (ratio * cosine - std::sqrt(1.0 - sine2)) * facing),
          false};
}

Vec3 specular_direction(const Material& material, const Vec3& normal, const Vec3& direction) {
  if (base::luminance(material.mirror) >= base::luminance(material.transmit)) {
    return glm::reflect(direction, normal);
  }
  return refract(material, normal, direction).direction;
}

}  // namespace earthshine::scenes
