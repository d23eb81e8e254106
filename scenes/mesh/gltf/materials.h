// SPDX-License-Identifier: Apache-2.0
// Conversion of glTF materials to Phong (docs/models.md has the mapping and its limits). Only files
// that own tinygltf include this.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "scenes/mesh/gltf/model.h"
#include "scenes/mesh/gltf/textures.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Below this roughness a highlight becomes a mirror.
inline constexpr double mirror_roughness = 0.05;
// A dielectric highlight with k_s below this is so wide and weak that it looks diffuse, and becomes
// diffuse. Up to twice this k_s, part of it does.
inline constexpr double least_highlight = 0.05;

// Vertex colours of a material: linear factors on its base colour.
struct VertexColours {
  glm::dvec4 mean{1.0};
  bool vary = false;  // false: all equal the mean
};

// Supports metallic-roughness and specular-glossiness; emissive_strength, ior, specular,
// transmission, volume (only whether the body is solid), unlit. Textures: base colour (k_d; its
// mean for metals and glass), emission, alpha of masks. All other textures and blended alpha are
// represented by their means. Vertex colours act like the base colour's texture.
struct GltfMaterial {
  Material material;
  CoordinateSets coordinates;
  std::vector<std::string> unsupported;  // unsupported properties that change the picture
};
// The textures that the material's conversion reads.
[[nodiscard]] std::vector<WantedTexture> textures_of(const tinygltf::Material& source);
[[nodiscard]] GltfMaterial phong_material(const tinygltf::Material& source,
                                          const VertexColours& colours, GltfTextures& textures);

// Fills the model's materials and assigns them to primitives. A primitive without a material has
// the format's default; one with COLOR_0 has a variant.
void find_worn_materials(GltfModel& model, GltfTextures& textures,
                         const std::filesystem::path& path);

}  // namespace earthshine::scenes
