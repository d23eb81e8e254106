// SPDX-License-Identifier: Apache-2.0
// Texture lines of an MTL file: map_Kd, map_Ke, map_d.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "scenes/text/text_lines.h"
#include "scenes/texture/texture.h"

namespace earthshine::scenes {

class MtlMaps {
 public:
  MtlMaps(std::filesystem::path library, std::span<const std::filesystem::path> folders,
          std::vector<std::filesystem::path>& files, std::vector<std::string>& warnings)
      : library_(std::move(library)), folders_(folders), files_(files), shelf_(warnings) {}

  // Reads the texture of a line: options -s, -o and -clamp, and its file beside the library or in
  // the folders. False for other options that change the texture, and without a file. A file that
  // cannot be read gives a warning and no texture. Throws base::Error (Input) for invalid option
  // values.
  [[nodiscard]] bool read(const TextLines& line, bool is_mask, TextureMap& map);

 private:
  std::filesystem::path library_;
  std::span<const std::filesystem::path> folders_;
  std::vector<std::filesystem::path>& files_;  // all requested files
  PictureShelf shelf_;
};

// Adds the existing files of all lines that reference a picture, including bump maps and other
// unused ones.
void list_map_files(std::string_view text, const std::filesystem::path& library,
                    std::vector<std::filesystem::path>& files);

}  // namespace earthshine::scenes
