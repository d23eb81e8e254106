// SPDX-License-Identifier: Apache-2.0
// Textures of a glTF file. Only the files that own tinygltf include this.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/texture/picture_shelf.h"

namespace earthshine::scenes {

// A texture as a material names it.
struct TextureSlot {
  int index = -1;       // -1: none
  int coordinates = 0;  // TEXCOORD_n
  tinygltf::Value transform;
};
[[nodiscard]] TextureSlot slot_of(const tinygltf::TextureInfo& info);
// `key` of an extension's table.
[[nodiscard]] TextureSlot slot_of(const tinygltf::Value& table, const char* key);

// Opens a picture that a file names, and gives its bytes. Throws base::Error (Input).
using OpenPicture = std::function<std::string(const std::string& uri)>;

class GltfTextures {
 public:
  GltfTextures(const tinygltf::Model& model, std::filesystem::path path, OpenPicture open,
               std::vector<std::string>& warnings)
      : model_(model), path_(std::move(path)), open_(std::move(open)), shelf_(warnings) {}

  // Without a texture where the slot has none or it cannot be read (a warning then).
  [[nodiscard]] TextureMap read(const TextureSlot& slot, bool is_srgb);

 private:
  [[nodiscard]] std::string bytes_of(const tinygltf::Image& image) const;

  const tinygltf::Model& model_;
  std::filesystem::path path_;
  OpenPicture open_;
  PictureShelf shelf_;
};

}  // namespace earthshine::scenes
