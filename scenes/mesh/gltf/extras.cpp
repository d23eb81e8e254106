// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/extras.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

constexpr std::string_view of_textures[] = {"KHR_texture_transform", "KHR_texture_basisu",
                                            "EXT_texture_webp", "EXT_texture_avif"};

// glTF-Transform's commands (gltf-transform.dev, in the npm registry).
std::string remedy_for(const std::string& extension) {
  constexpr const char* run = "npx @gltf-transform/cli";
  if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression") {
    return fmt::format("Decompress it: {} copy IN.glb OUT.glb", run);
  }
  if (extension == "KHR_mesh_quantization") {
    return fmt::format("Write its numbers out: {} dequantize IN.glb OUT.glb", run);
  }
  return "Export it without";
}

}  // namespace

std::map<std::string, std::size_t> unused_of(const tinygltf::Model& model) {
  std::map<std::string, std::size_t> unused;
  const auto count = [&](const std::string& what, std::size_t number) {
    if (number > 0) unused[what] += number;
  };
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      for (const auto& [name, accessor] : primitive.attributes) {
        if (name != "POSITION") count(name, 1);
      }
    }
  }
  for (const tinygltf::Material& material : model.materials) {
    const bool passes = material.extensions.count("KHR_materials_transmission") > 0;
    if (material.alphaMode == "BLEND" || material.alphaMode == "MASK" || passes) {
      count(transparent, 1);
    }
  }
  count("textures", model.textures.size());
  count("lights", model.lights.size());
  count("cameras", model.cameras.size());
  count("skins", model.skins.size());
  count("animations", model.animations.size());
  for (const std::string& extension : model.extensionsUsed) count(extension, 1);
  return unused;
}

void check_required_extensions(const tinygltf::Model& model, const std::filesystem::path& path) {
  for (const std::string& extension : model.extensionsRequired) {
    if (std::find(std::begin(of_textures), std::end(of_textures), extension) !=
        std::end(of_textures)) {
      continue;
    }
    throw base::Error(base::Blame::Input, base::Location{path.string()},
                      fmt::format("needs the glTF extension {}", in_quotes(extension)),
                      "files that need none are read", remedy_for(extension));
  }
}

}  // namespace earthshine::scenes
