// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <string>
#include <vector>

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

GreyPixels read_grey_png(std::string_view bytes, std::string_view named) {
  // The simplified interface converts 16 bits by an sRGB curve that the file may not have.
  struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string_view left;
    std::string why;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  } reader;
  reader.left = bytes;
  reader.png = png_create_read_struct(
      PNG_LIBPNG_VER_STRING, &reader,
      [](png_structp png, png_const_charp why) {
        static_cast<Reader*>(png_get_error_ptr(png))->why = why;
        png_longjmp(png, 1);
      },
      [](png_structp, png_const_charp) {});
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) refuse_png(named, "libpng has no memory");
  png_set_read_fn(reader.png, &reader, [](png_structp png, png_bytep to, std::size_t count) {
    auto& left = static_cast<Reader*>(png_get_io_ptr(png))->left;
    if (left.size() < count) png_error(png, "it is cut off");
    std::copy_n(left.begin(), count, reinterpret_cast<char*>(to));
    left.remove_prefix(count);
  });
  GreyPixels grey;
  std::vector<png_byte> row;
  if (setjmp(png_jmpbuf(reader.png)) != 0) refuse_png(named, reader.why);
  png_read_info(reader.png, reader.info);
  const std::uint32_t width = png_get_image_width(reader.png, reader.info);
  const std::uint32_t height = png_get_image_height(reader.png, reader.info);
  check_size(width, height, named);
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY ||
      png_get_interlace_type(reader.png, reader.info) != PNG_INTERLACE_NONE) {
    throw Error(Blame::Input, named, "is no plain grey picture",
                "allowed is a grey PNG of 8 or 16 bits, without alpha and interlace");
  }
  const int bits = png_get_bit_depth(reader.png, reader.info);
  if (bits < 8) png_set_expand_gray_1_2_4_to_8(reader.png);
  const std::size_t bytes_each = bits == 16 ? 2 : 1;
  row.resize(width * bytes_each);
  grey.width = static_cast<int>(width);
  grey.height = static_cast<int>(height);
  grey.values.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y) {
    png_read_row(reader.png, row.data(), nullptr);
    for (std::uint32_t x = 0; x < width; ++x) {
      grey.values.push_back(bits == 16 ? (256.0 * row[2 * x] + row[2 * x + 1]) / 65535.0
                                       : row[x] / 255.0);
    }
  }
  return grey;
}

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
