// SPDX-License-Identifier: Apache-2.0
// Reads and writes PNG files (libpng; only png_file.cpp uses it).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace earthshine::base {

// pixels: width * height * channels bytes in rows from the top, sRGB encoded; channels is 1 (grey)
// or 3 (RGB). text: tEXt chunks with keywords of up to 79 characters. Writes a temporary file and
// renames it. Throws base::Error (Work) if the file cannot be written.
void write_png(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const std::uint8_t> pixels,
               const std::vector<std::pair<std::string, std::string>>& text = {});

// Grey of 16 bits, without a transfer function: depths. Throws as above.
void write_png16(const std::filesystem::path& path, int width, int height,
                 std::span<const std::uint16_t> pixels);

// 8 bits per channel, in display values.
struct Picture8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // width * height * 3, rows from the top
};

inline constexpr int largest_png_edge_px = 16384;

// Reads any PNG: grey, palette or RGB of 1 to 16 bits, interlaced or not. 16 bits are rounded to 8,
// transparent pixels are blended over black, profiles and gamma are ignored. Throws base::Error
// (Input) if the file is missing, not a PNG, broken, truncated or larger than 16384 pixels on an
// edge.
[[nodiscard]] Picture8 read_png(const std::filesystem::path& path);

}  // namespace earthshine::base
