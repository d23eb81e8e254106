// SPDX-License-Identifier: Apache-2.0
// Textures of a glTF file. Only the files that own tinygltf include this.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "scenes/scene.h"
#include "scenes/texture/texture.h"

namespace earthshine::scenes {

// Texture reference of a material.
struct TextureSlot {
  int index = -1;       // -1: none
  int coordinates = 0;  // TEXCOORD_n
  tinygltf::Value transform;
};
[[nodiscard]] TextureSlot slot_of(const tinygltf::TextureInfo& info);
// Reads `key` of an extension's table.
[[nodiscard]] TextureSlot slot_of(const tinygltf::Value& table, const char* key);

// Reads a picture that a file references. Throws base::Error (Input).
using OpenPicture = std::function<std::string(const std::string& uri)>;

struct WantedTexture {
  TextureSlot slot;
  bool is_srgb = true;
};

class GltfTextures {
 public:
  GltfTextures(const tinygltf::Model& model, std::filesystem::path path, OpenPicture open,
               std::vector<std::string>& warnings)
      : model_(model), path_(std::move(path)), open_(std::move(open)), shelf_(warnings) {}

  // Loads the textures that read() will need, on all threads.
  void prepare(std::span<const WantedTexture> wanted);

  // No texture if the slot has none, or if it cannot be read (with a warning).
  [[nodiscard]] TextureMap read(const TextureSlot& slot, bool is_srgb);

 private:
  [[nodiscard]] TextureReading reading_of(const TextureSlot& slot, bool is_srgb) const;
  [[nodiscard]] const tinygltf::Image* image_of(const TextureSlot& slot) const;
  [[nodiscard]] std::string bytes_of(const tinygltf::Image& image) const;

  const tinygltf::Model& model_;
  std::filesystem::path path_;
  OpenPicture open_;
  PictureShelf shelf_;
};

// Values of glTF extensions, which may be of any type or missing. Only files that own tinygltf
// include this.

// Clamps to [0, most]; 0 if not finite.
[[nodiscard]] inline double in_range(double x, double most = 1.0) {
  return std::isfinite(x) ? std::clamp(x, 0.0, most) : 0.0;
}

// First three values, each clamped to [0, most].
[[nodiscard]] inline Rgb colour_of(const std::vector<double>& values, double otherwise,
                                   double most = 1.0) {
  if (values.size() < 3) return Rgb(otherwise);
  return {in_range(values[0], most), in_range(values[1], most), in_range(values[2], most)};
}

// The extension, or an empty value.
[[nodiscard]] inline tinygltf::Value extension_of(const tinygltf::ExtensionMap& extensions,
                                                  const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? tinygltf::Value() : found->second;
}

[[nodiscard]] inline double number_of(const tinygltf::Value& table, const char* key,
                                      double otherwise) {
  if (!table.IsObject() || !table.Has(key)) return otherwise;
  const tinygltf::Value& value = table.Get(key);
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(number) ? number : otherwise;
}

[[nodiscard]] inline std::vector<double> numbers_of(const tinygltf::Value& table, const char* key) {
  std::vector<double> numbers;
  if (!table.IsObject() || !table.Has(key)) return numbers;
  const tinygltf::Value& array = table.Get(key);
  for (std::size_t k = 0; array.IsArray() && k < array.ArrayLen(); ++k) {
    const tinygltf::Value& value = array.Get(static_cast<int>(k));
    numbers.push_back(value.IsNumber() ? value.GetNumberAsDouble() : 0.0);
  }
  return numbers;
}

}  // namespace earthshine::scenes
