// SPDX-License-Identifier: Apache-2.0
#include "scenes/mask.h"

#include <algorithm>

#include "scenes/texture/texture.h"

namespace earthshine::scenes {
OpacityMasks::OpacityMasks(const Scene& scene) {
  for (const Material& material : scene.materials) {
    if (material.has_holes()) maps_.push_back(material.maps);
  }
  if (maps_.empty()) return;
  number_.assign(scene.triangles.size(), unmasked);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const Triangle& triangle = scene.triangles[t];
    const Material& material = scene.materials[triangle.material];
    if (!material.has_holes()) continue;
    number_[t] = static_cast<std::uint32_t>(masked_.size());
    masked_.push_back({{scene.vertex_uv[triangle.vertex[0]], scene.vertex_uv[triangle.vertex[1]],
                        scene.vertex_uv[triangle.vertex[2]]},
                       material.maps.get()});
  }
}

bool OpacityMasks::has_hole(std::uint32_t number, double u, double v) const {
  const Masked& masked = masked_[number];
  return !is_opaque(*masked.maps, (1.0 - u - v) * glm::dvec2(masked.uv[0]) +
                                      u * glm::dvec2(masked.uv[1]) + v * glm::dvec2(masked.uv[2]));
}

bool any_has_holes(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.has_holes(); });
}

bool is_opaque(const MaterialMaps& maps, const glm::dvec2& uv) {
  const TextureMap& map = maps.opacity;
  return !map.texture || map.texture->at(map.transform->apply(uv)).a >= maps.cutoff;
}

}  // namespace earthshine::scenes
