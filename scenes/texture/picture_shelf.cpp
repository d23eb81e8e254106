// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/picture_shelf.h"

#include <fmt/format.h>

#include "base/error.h"

namespace earthshine::scenes {
namespace {

bool same_reading(const TextureReading& a, const TextureReading& b) {
  return a.name == b.name && a.is_srgb == b.is_srgb && a.is_mask == b.is_mask &&
         a.is_crisp == b.is_crisp && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v;
}

}  // namespace

std::shared_ptr<const Texture> PictureShelf::take(const TextureReading& reading,
                                                  const std::function<std::string()>& read) {
  for (const Shelved& known : shelved_) {
    if (same_reading(known.reading, reading)) return known.texture;
  }
  std::shared_ptr<const Texture> made;
  try {
    made = std::make_shared<const Texture>(base::read_pixels(read(), reading.name), reading);
  } catch (const base::Error& error) {
    if (error.blame() != base::Blame::Input) throw;
    warnings_.push_back(
        fmt::format("a texture is left out, the plain colour stays: {}", error.what()));
  }
  shelved_.push_back({reading, made});
  return made;
}

}  // namespace earthshine::scenes
