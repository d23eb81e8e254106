// SPDX-License-Identifier: Apache-2.0
// Writing 8-bit PNG files (libpng). The only user of the library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace earthshine::base {

// pixels: width * height * channels bytes, rows from the top; channels 1 (grey) or 3 (RGB), sRGB
// encoded. text: tEXt chunks (keyword up to 79 characters). Written aside and renamed. Throws
// base::Error (Work) when the file cannot be written.
void write_png(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const std::uint8_t> pixels,
               const std::vector<std::pair<std::string, std::string>>& text = {});

}  // namespace earthshine::base
