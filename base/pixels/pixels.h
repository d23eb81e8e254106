// SPDX-License-Identifier: Apache-2.0
// Decodes pictures in memory: PNG (libpng) and JPEG (libjpeg-turbo).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace earthshine::base {

// Stored values, 8 bits per channel; 16 bits are rounded.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4, rows from the top
};

inline constexpr int largest_picture_edge_px = 16384;

// Selects the decoder by the signature, not by the file name. Throws base::Error (Input) at `named`
// for another format, a broken or truncated file, or more than 16384 pixels on an edge.
[[nodiscard]] Pixels read_pixels(std::string_view bytes, std::string_view named);

// A grey PNG file's values over the largest one that its 8 or 16 bits store, from 0 to 1, in rows
// from the top; no sRGB curve is applied. Throws base::Error (Input) for colours and alpha.
struct GreyPixels {
  int width = 0;
  int height = 0;
  std::vector<double> values;
};
[[nodiscard]] GreyPixels read_grey_png(std::string_view bytes, std::string_view named);

[[nodiscard]] Pixels read_png_pixels(std::string_view bytes, std::string_view named);
[[nodiscard]] Pixels read_jpeg_pixels(std::string_view bytes, std::string_view named);

// Throws if the picture is empty, an edge is too large or memory is short.
void check_size(std::uint64_t width, std::uint64_t height, std::string_view named);

}  // namespace earthshine::base
