// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include "base/error.h"
#include "base/files/png_file.h"
#include "base/free_memory.h"
#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

// libpng reports failure by a long jump, which must not cross a C++ object with a destructor:
// everything of that kind lives in the caller, and the message is kept here.
struct Source {
  std::ifstream file;
  char message[128] = {};
};

extern "C" {
static void take_bytes(png_structp png, png_bytep data, size_t size) {
  auto& file = static_cast<Source*>(png_get_io_ptr(png))->file;
  file.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(size));
  if (!file) png_error(png, "it ends too early");
}
static void keep_read_message(png_structp png, png_const_charp message) {
  auto* source = static_cast<Source*>(png_get_error_ptr(png));
  std::snprintf(source->message, sizeof source->message, "%s", message);
  png_longjmp(png, 1);
}
static void ignore_read_warning(png_structp, png_const_charp) {}
}

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  explicit Reader(Source& source)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_read_message,
                                   ignore_read_warning)) {
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

// The two steps hold nothing with a destructor (see Source) and return false when libpng failed.
bool read_header(const Reader& r, Source& source) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_set_read_fn(r.png, &source, take_bytes);
  // Ours is the limit that says what it is.
  png_set_user_limits(r.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_read_info(r.png, r.info);
  png_set_expand(r.png);  // palette and small greys to 8 bits, transparency to alpha
  png_set_scale_16(r.png);
  png_set_gray_to_rgb(r.png);
  png_set_add_alpha(r.png, 0xFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  return true;
}

bool read_rows(const Reader& r, png_byte** rows) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_read_image(r.png, rows);
  png_read_end(r.png, nullptr);
  return true;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found,
                         std::string_view allowed = {}, std::string_view remedy = {}) {
  throw Error(Blame::Input, path.string(), found, allowed, remedy);
}

void open(Source& source, const std::filesystem::path& path) {
  check_input_file(path, {path.string()});
  errno = 0;
  source.file.open(path, std::ios::binary);
  if (!source.file) {
    refuse(path, "cannot be read: " + system_reason(errno));
  }
  png_byte signature[8] = {};
  source.file.read(reinterpret_cast<char*>(signature), sizeof signature);
  if (!source.file || png_sig_cmp(signature, 0, sizeof signature) != 0) {
    refuse(path, "is not a PNG file", "photographs are read as PNG",
           "Convert it, for example with convert photo.jpg photo.png");
  }
  source.file.seekg(0);
}

}  // namespace

Picture8 read_png(const std::filesystem::path& path) {
  Source source;
  open(source, path);
  const auto broken = [&] {
    if (source.message[0] == '\0') throw std::bad_alloc();
    refuse(path, std::string("is a broken PNG file: ") + source.message, {},
           "Save the picture once more");
  };
  const Reader reader(source);
  if (reader.info == nullptr) throw std::bad_alloc();
  if (!read_header(reader, source)) broken();
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  if (width > largest_png_edge_px || height > largest_png_edge_px) {
    refuse(path, "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
           "the largest picture read is 16384 x 16384", "Crop or shrink it");
  }
  constexpr std::size_t rgba = 4;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  check_room((rgba + 3) * pixels, path.string());
  std::vector<png_byte> bytes(rgba * pixels);
  std::vector<png_byte*> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = bytes.data() + y * rgba * width;
  if (!read_rows(reader, rows.data())) broken();

  Picture8 picture{static_cast<int>(width), static_cast<int>(height), {}};
  picture.rgb.resize(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const unsigned alpha = bytes[rgba * p + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      picture.rgb[3 * p + c] = static_cast<std::uint8_t>((bytes[rgba * p + c] * alpha + 127) / 255);
    }
  }
  return picture;
}

}  // namespace earthshine::base
