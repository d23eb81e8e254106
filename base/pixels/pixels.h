// SPDX-License-Identifier: Apache-2.0
// Pictures in memory to pixels: PNG (libpng) and JPEG (libjpeg-turbo).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace earthshine::base {

// As the file has them, 8 bits a channel; 16 bits are rounded.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, rows from the top
};

inline constexpr int largest_picture_edge_px = 16384;

// By the signature of the bytes, whatever the name says. Throws base::Error (Input) at `named` for
// another format, a broken file, one cut short, and more than 16384 pixels an edge.
[[nodiscard]] Pixels read_pixels(std::string_view bytes, std::string_view named);

[[nodiscard]] Pixels read_png_pixels(std::string_view bytes, std::string_view named);
[[nodiscard]] Pixels read_jpeg_pixels(std::string_view bytes, std::string_view named);

// Throws unless both edges are allowed, the picture has pixels, and there is room for them.
void check_size(std::uint64_t width, std::uint64_t height, std::string_view named);

}  // namespace earthshine::base
