// SPDX-License-Identifier: Apache-2.0
// glTF's materials as Phong (docs/models.md has the map and what it misses). Only the files that
// own tinygltf include this.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "scenes/mesh/gltf/model.h"
#include "scenes/mesh/gltf/textures.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Below this roughness a highlight is a mirror's.
inline constexpr double mirror_roughness = 0.05;
// A highlight of a dielectric whose k_s is below this is wider and weaker than can be told from
// diffuse light and becomes that; up to twice this k_s a share of it does.
inline constexpr double least_highlight = 0.05;

// Colours of the vertices that wear a material: linear factors of its base colour.
struct VertexColours {
  glm::dvec4 mean{1.0};
  bool vary = false;  // false: all of them are the mean
};

// Metallic-roughness, or specular-glossiness; emissive_strength, ior, specular, transmission,
// volume (whether it is solid), unlit. Textures: base colour (k_d; its mean in what metal reflects
// and glass passes), emission, the alpha of masks; of all others and of blended alpha the mean.
// Colours of vertices as the base colour's texture.
struct GltfMaterial {
  Material material;
  CoordinateSets coordinates;
  std::vector<std::string> lacks;  // what it has that Phong has not and that changes the picture
};
// The textures that a material's conversion reads.
[[nodiscard]] std::vector<WantedTexture> textures_of(const tinygltf::Material& source);
[[nodiscard]] GltfMaterial phong_material(const tinygltf::Material& source,
                                          const VertexColours& colours, GltfTextures& textures);

// Fills the model's materials, and what its primitives wear: a primitive without a material the
// format's default, one with COLOR_0 a variant.
void find_worn_materials(GltfModel& model, GltfTextures& textures,
                         const std::filesystem::path& path);

}  // namespace earthshine::scenes
