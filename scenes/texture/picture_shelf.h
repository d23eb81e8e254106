// SPDX-License-Identifier: Apache-2.0
// Textures of mesh files. What cannot be read leaves the plain colour and a warning: models are
// handed round without their pictures more often than not.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/texture/texture.h"

namespace earthshine::scenes {

// One picture of a file in memory for each way of reading it.
class PictureShelf {
 public:
  // `warnings` is the mesh's, and must outlive the shelf.
  explicit PictureShelf(std::vector<std::string>& warnings) : warnings_(warnings) {}

  // The texture of the bytes that `read` gives, which is called for each new key. Null, and a
  // warning, where that or the picture fails with base::Error (Input).
  [[nodiscard]] std::shared_ptr<const Texture> take(const TextureReading& reading,
                                                    const std::function<std::string()>& read);

 private:
  struct Shelved {
    TextureReading reading;
    std::shared_ptr<const Texture> texture;
  };
  std::vector<Shelved> shelved_;
  std::vector<std::string>& warnings_;
};

}  // namespace earthshine::scenes
