// SPDX-License-Identifier: Apache-2.0
// glTF's materials as Phong (docs/models.md has the map and what it misses). Only the files that
// own tinygltf include this.
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <string>

#include "scenes/mesh/gltf/textures.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Below this roughness a highlight is a mirror's.
inline constexpr double mirror_roughness = 0.05;
// A highlight of a dielectric whose k_s is below this is wider and weaker than can be told from the
// diffuse light that it would take away: it is left out, and k_d is the whole base colour.
inline constexpr double least_highlight = 0.05;

// Metallic-roughness, or specular-glossiness; emissive_strength, ior, specular, transmission,
// volume (whether it is solid), unlit. What they have that Phong has not is counted in `unused`.
// Textures: base colour (k_d; its mean in what metal reflects and glass passes), emission, the
// alpha of masks; of metallic-roughness maps and of blended alpha the mean.
struct GltfMaterial {
  Material material;
  int coordinates = 0;  // TEXCOORD_n of its textures
};
[[nodiscard]] GltfMaterial phong_material(const tinygltf::Material& source, GltfTextures& textures,
                                          std::map<std::string, std::size_t>& unused);

}  // namespace earthshine::scenes
