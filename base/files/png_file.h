// SPDX-License-Identifier: Apache-2.0
// Reading and writing PNG files (libpng; png_file.cpp is its only user).
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

// 8 bits per channel, as a screen shows them.
struct Picture8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // width * height * 3, rows from the top
};

inline constexpr int largest_png_edge_px = 16384;

// Any PNG: grey, palette or RGB of 1 to 16 bits, interlaced or not. 16 bits are rounded to 8, what
// is transparent is laid on black; profiles and gamma are not applied. Throws base::Error (Input)
// for a file that is missing, another format, broken, cut short or larger than 16384 pixels an
// edge.
[[nodiscard]] Picture8 read_png(const std::filesystem::path& path);

}  // namespace earthshine::base
