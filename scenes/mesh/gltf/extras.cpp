// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/extras.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "scenes/mesh.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view of_textures[] = {"KHR_texture_basisu", "EXT_texture_webp",
                                            "EXT_texture_avif"};
// Those that the readers here look into.
constexpr std::string_view known[] = {
    "KHR_mesh_quantization",      "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_volume",   "KHR_materials_unlit",
    "KHR_texture_transform"};

template <std::size_t N>
bool among(const std::string& name, const std::string_view (&names)[N]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// glTF-Transform's commands (gltf-transform.dev, in the npm registry).
std::string remedy_for(const std::string& extension) {
  constexpr const char* run = "npx @gltf-transform/cli";
  if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression") {
    return fmt::format("Decompress it: {} copy IN.glb OUT.glb", run);
  }
  return "Export it without";
}

bool has_texture(const tinygltf::Model& model, int material) {
  if (material < 0 || static_cast<std::size_t>(material) >= model.materials.size()) return false;
  const tinygltf::Material& found = model.materials[static_cast<std::size_t>(material)];
  return found.pbrMetallicRoughness.baseColorTexture.index >= 0 ||
         found.emissiveTexture.index >= 0 ||
         found.extensions.count("KHR_materials_pbrSpecularGlossiness") > 0;
}

}  // namespace

std::map<std::string, std::size_t> unused_of(const tinygltf::Model& model) {
  std::map<std::string, std::size_t> unused;
  const auto count = [&](const std::string& what, std::size_t number) {
    if (number > 0) unused[what] += number;
  };
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const bool textured = has_texture(model, primitive.material);
      for (const auto& [name, accessor] : primitive.attributes) {
        if (name != "POSITION" && !(textured && name == "TEXCOORD_0")) count(name, 1);
      }
    }
  }
  for (const tinygltf::Light& light : model.lights) {
    const bool is_lamp = light.type == "point" || light.type == "spot";
    count(is_lamp                       ? lamps_of_file
          : light.type == "directional" ? "directional lights (say [sun])"
                                        : "lights of an unknown type",
          1);
  }
  count(cameras_of_file, model.cameras.size());
  count("skins", model.skins.size());
  count("animations", model.animations.size());
  for (const std::string& extension : model.extensionsUsed) {
    if (!among(extension, known)) count(extension, 1);
  }
  return unused;
}

void check_required_extensions(const tinygltf::Model& model, const std::filesystem::path& path) {
  for (const std::string& extension : model.extensionsRequired) {
    if (among(extension, of_textures) || among(extension, known)) continue;
    throw base::Error(base::Blame::Input, base::Location{path.string()},
                      fmt::format("needs the glTF extension {}", in_quotes(extension)),
                      "files that need none, or one of docs/models.md, are read",
                      remedy_for(extension));
  }
}

}  // namespace earthshine::scenes
