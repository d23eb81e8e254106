// SPDX-License-Identifier: Apache-2.0
#include "scenes/reflect/specular.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "scenes/specular_paths.h"

namespace earthshine::scenes {
bool any_passes_light_on(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.passes_light_on(); });
}

Refraction refract(const Material& material, const Vec3& normal, const Vec3& direction) {
  if (is_straight_glass(material)) return {direction, false};
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

SpecularStep specular_step(const Scene& scene, const Hit& hit, const Vec3& direction,
                           double offset_m, bool aimed) {
  constexpr double drawn_in = 1e-5;
  const Triangle& triangle = scene.triangles[hit.triangle];
  const Vec3 normal = triangle_normal(scene, hit.triangle);
  const Vec3 onward = specular_direction(scene.materials[triangle.material], normal, direction);
  if (aimed && goes_straight_on(direction, onward)) {
    const auto behind =
        straight_through(scene, hit.triangle, hit_position(scene, hit), onward, offset_m);
    if (behind) return {*behind, onward};
  }
  const double side = glm::dot(onward, normal) > 0.0 ? 1.0 : -1.0;
  Hit inner = hit;
  inner.u = (1.0 - drawn_in) * hit.u + drawn_in / 3.0;
  inner.v = (1.0 - drawn_in) * hit.v + drawn_in / 3.0;
  return {hit_position(scene, inner) + normal * (side * offset_m), onward};
}

}  // namespace earthshine::scenes
