// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <string>

#include "base/error.h"
#include "base/pixels/pixels.h"

namespace earthshine::base {
namespace {

// RAII: frees libpng's data.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

[[noreturn]] void refuse_png(std::string_view named, const std::string& why) {
  throw Error(Blame::Input, named, "is a broken PNG file: " + why, {},
              "Save the picture once more");
}

}  // namespace

Pixels read_png_pixels(std::string_view bytes, std::string_view named) {
  PngImage png;
  if (png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size()) == 0) {
    refuse_png(named, png.image.message);
  }
  check_size(png.image.width, png.image.height, named);
  png.image.format = PNG_FORMAT_RGBA;
  Pixels pixels{static_cast<int>(png.image.width), static_cast<int>(png.image.height), {}};
  pixels.rgba.resize(PNG_IMAGE_SIZE(png.image));
  if (png_image_finish_read(&png.image, nullptr, pixels.rgba.data(), 0, nullptr) == 0) {
    refuse_png(named, png.image.message);
  }
  return pixels;
}

}  // namespace earthshine::base
