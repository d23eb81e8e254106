// SPDX-License-Identifier: Apache-2.0
#include "base/pixels/pixels.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/free_memory.h"

namespace earthshine::base {
namespace {

// Bytes of the picture, and of the texture made from it with its mipmaps.
constexpr std::uint64_t bytes_per_pixel = 4 + 8 * 4 / 3;

}  // namespace

Pixels read_pixels(std::string_view bytes, std::string_view named) {
  if (bytes.starts_with("\x89PNG")) return read_png_pixels(bytes, named);
  if (bytes.starts_with("\xFF\xD8")) return read_jpeg_pixels(bytes, named);
  throw Error(Blame::Input, named, "is neither a PNG nor a JPEG file",
              "textures are read as PNG or JPEG",
              "Convert it, for example with convert IN OUT.png");
}

void check_size(std::uint64_t width, std::uint64_t height, std::string_view named) {
  constexpr std::uint64_t most = largest_picture_edge_px;
  if (width < 1 || height < 1 || width > most || height > most) {
    throw Error(Blame::Input, named, fmt::format("has {} x {} pixels", width, height),
                fmt::format("the largest picture read is {0} x {0}", most), "Shrink it");
  }
  check_room(width * height * bytes_per_pixel, named);
}

}  // namespace earthshine::base
