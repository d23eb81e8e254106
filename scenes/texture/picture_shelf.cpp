// SPDX-License-Identifier: Apache-2.0
#include "scenes/texture/picture_shelf.h"

#include <fmt/format.h>

#include "base/error.h"

namespace earthshine::scenes {
std::shared_ptr<const Texture> PictureShelf::take(const TextureReading& reading,
                                                  const std::function<std::string()>& read) {
  for (const Shelved& known : shelved_) {
    if (known.reading == reading) return known.texture;
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
