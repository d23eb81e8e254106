// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/textures.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"

namespace earthshine::scenes {
namespace {

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror : Wrap::Repeat;
}

// Decodes percent encoding: "my%20wood.png" becomes "my wood.png".
std::string decoded(const std::string& uri) {
  std::string name;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    const auto digit = [&](std::size_t at) {
      const char c = at < uri.size() ? uri[at] : 'x';
      if (c >= '0' && c <= '9') return c - '0';
      if (c >= 'a' && c <= 'f') return c - 'a' + 10;
      return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    const int high = digit(k + 1), low = digit(k + 2);
    if (uri[k] != '%' || high < 0 || low < 0) {
      name += uri[k];
    } else {
      name += static_cast<char>(16 * high + low);
      k += 2;
    }
  }
  return name;
}

// KHR_texture_transform: scale, counter-clockwise rotation as seen on the picture (whose v points
// down), offset.
TextureTransform transform_of(const tinygltf::Value& table) {
  const auto two = [&](const char* key, double otherwise) {
    const std::vector<double> numbers = numbers_of(table, key);
    return numbers.size() < 2 ? glm::dvec2(otherwise) : glm::dvec2(numbers[0], numbers[1]);
  };
  const glm::dvec2 scale = two("scale", 1.0);
  const double angle = number_of(table, "rotation", 0.0);
  const double c = std::cos(angle), s = std::sin(angle);
  TextureTransform transform;
  transform.matrix = glm::dmat2(c, -s, s, c) * glm::dmat2(scale.x, 0.0, 0.0, scale.y);
  transform.shift = two("offset", 0.0);
  return transform;
}

}  // namespace

TextureSlot slot_of(const tinygltf::TextureInfo& info) {
  const tinygltf::Value transform = extension_of(info.extensions, "KHR_texture_transform");
  const double set = number_of(transform, "texCoord", double(info.texCoord));
  return {info.index, static_cast<int>(set), transform};
}

TextureSlot slot_of(const tinygltf::Value& table, const char* key) {
  if (!table.IsObject() || !table.Has(key)) return {};
  const tinygltf::Value& info = table.Get(key);
  TextureSlot slot;
  slot.index = static_cast<int>(number_of(info, "index", -1.0));
  slot.coordinates = static_cast<int>(number_of(info, "texCoord", 0.0));
  if (!info.IsObject() || !info.Has("extensions")) return slot;
  const tinygltf::Value& extensions = info.Get("extensions");
  if (extensions.IsObject() && extensions.Has("KHR_texture_transform")) {
    slot.transform = extensions.Get("KHR_texture_transform");
    slot.coordinates =
        static_cast<int>(number_of(slot.transform, "texCoord", double(slot.coordinates)));
  }
  return slot;
}

TextureReading GltfTextures::reading_of(const TextureSlot& slot, bool is_srgb) const {
  const bool exists = static_cast<std::size_t>(slot.index) < model_.textures.size();
  const tinygltf::Texture texture =
      exists ? model_.textures[static_cast<std::size_t>(slot.index)] : tinygltf::Texture();
  TextureReading reading;
  reading.is_srgb = is_srgb;
  const auto sampler = static_cast<std::size_t>(texture.sampler);
  if (texture.sampler >= 0 && sampler < model_.samplers.size()) {
    reading.wrap_u = wrap_of(model_.samplers[sampler].wrapS);
    reading.wrap_v = wrap_of(model_.samplers[sampler].wrapT);
    reading.is_crisp = model_.samplers[sampler].magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  const auto number = static_cast<std::size_t>(texture.source);
  const bool has_image = texture.source >= 0 && number < model_.images.size();
  if (!has_image) {
    reading.name = fmt::format("{}, texture {}", path_.string(), slot.index);
  } else if (const std::string& uri = model_.images[number].uri; !uri.empty()) {
    reading.name = decoded(uri);
  } else {
    reading.name = fmt::format("{}, image {}", path_.string(), number);
  }
  return reading;
}

const tinygltf::Image* GltfTextures::image_of(const TextureSlot& slot) const {
  if (static_cast<std::size_t>(slot.index) >= model_.textures.size()) return nullptr;
  const int source = model_.textures[static_cast<std::size_t>(slot.index)].source;
  const auto number = static_cast<std::size_t>(source);
  return source >= 0 && number < model_.images.size() ? &model_.images[number] : nullptr;
}

void GltfTextures::prepare(std::span<const WantedTexture> wanted) {
  std::vector<PictureShelf::Picture> pictures;
  for (const auto& [slot, is_srgb] : wanted) {
    const tinygltf::Image* const image = slot.index < 0 ? nullptr : image_of(slot);
    if (image == nullptr) continue;
    PictureShelf::Picture picture{reading_of(slot, is_srgb), {}};
    const bool known = std::any_of(pictures.begin(), pictures.end(), [&](const auto& other) {
      return other.reading == picture.reading;
    });
    if (known) continue;
    try {
      picture.bytes = bytes_of(*image);
    } catch (const base::Error&) {  // reported by read()
      continue;
    }
    pictures.push_back(std::move(picture));
  }
  shelf_.prepare(pictures);
}

TextureMap GltfTextures::read(const TextureSlot& slot, bool is_srgb) {
  if (slot.index < 0) return {};
  const bool exists = static_cast<std::size_t>(slot.index) < model_.textures.size();
  const tinygltf::Image* const image = image_of(slot);
  TextureMap map;
  map.texture = shelf_.take(reading_of(slot, is_srgb), [&] {
    if (!exists) {
      throw base::Error(base::Blame::Input, base::Location{path_.string()},
                        fmt::format("texture {} does not exist", slot.index),
                        fmt::format("the file has {}", model_.textures.size()));
    }
    if (image == nullptr) {
      throw base::Error(base::Blame::Input, base::Location{path_.string()},
                        fmt::format("texture {} has no image of a kind that is read", slot.index),
                        "images are PNG or JPEG");
    }
    return bytes_of(*image);
  });
  if (map.texture) {
    map.transform = std::make_shared<const TextureTransform>(transform_of(slot.transform));
  }
  return map;
}

std::string GltfTextures::bytes_of(const tinygltf::Image& image) const {
  if (image.image.empty()) return open_(decoded(image.uri));
  return {image.image.begin(), image.image.end()};
}

}  // namespace earthshine::scenes
