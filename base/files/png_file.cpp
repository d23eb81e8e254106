// SPDX-License-Identifier: Apache-2.0
#include "base/files/png_file.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <fstream>
#include <new>

#include "base/error.h"
#include "base/files/output_file.h"
#include "base/free_memory.h"
#include "base/input/input_file.h"

namespace earthshine::base {
namespace {

using Texts = std::vector<std::pair<std::string, std::string>>;

// libpng reports errors by longjmp, which must not skip a destructor. The callers own all objects
// with destructors; the message is stored here.
struct Sink {
  std::string bytes;
  char message[128] = {};
};

extern "C" {
static void append_bytes(png_structp png, png_bytep data, size_t size) {
  bool stored = true;
  try {
    static_cast<Sink*>(png_get_io_ptr(png))
        ->bytes.append(reinterpret_cast<const char*>(data), size);
  } catch (...) {
    stored = false;
  }
  if (!stored) png_error(png, "out of memory");
}
static void flush_nothing(png_structp) {}
static void keep_message(png_structp png, png_const_charp message) {
  Sink* sink = static_cast<Sink*>(png_get_error_ptr(png));
  std::snprintf(sink->message, sizeof sink->message, "%s", message);
  png_longjmp(png, 1);
}
static void ignore_warning(png_structp, png_const_charp) {}
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::vector<png_text> text_chunks(const Texts& texts) {
  std::vector<png_text> chunks;
  for (const auto& [keyword, value] : texts) {
    if (keyword.empty() || keyword.size() > 79 || !is_ascii(keyword)) {
      throw Error(Blame::Work, "PNG text \"" + keyword + "\"", "is not a keyword",
                  "keywords have 1 to 79 ASCII characters");
    }
    png_text chunk{};
    // tEXt is Latin-1; other letters need iTXt, which is UTF-8.
    chunk.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(keyword.c_str());
    chunk.text = const_cast<char*>(value.c_str());
    if (is_ascii(value)) {
      chunk.text_length = value.size();
    } else {
      chunk.itxt_length = value.size();
    }
    chunks.push_back(chunk);
  }
  return chunks;
}

struct Picture {
  png_uint_32 width, height;
  int colour_type;
  int bits;
  const png_byte* const* rows;
  const png_text* text;
  int text_count;
};

// On the payload bay, 4 % more bytes than level 6 in 0.36 of the time.
constexpr int compression_level = 4;

// No objects with destructors here (see Sink). Returns false if libpng failed.
bool encode(png_structp png, png_infop info, const Picture& picture) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, picture.width, picture.height, picture.bits, picture.colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, compression_level);
  if (picture.bits == 8) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (picture.text_count > 0) png_set_text(png, info, picture.text, picture.text_count);
  png_write_info(png, info);
  for (png_uint_32 y = 0; y < picture.height; ++y) png_write_row(png, picture.rows[y]);
  png_write_end(png, nullptr);
  return true;
}

// libpng reports errors by longjmp, which must not skip a destructor. The callers own all objects
// with destructors; the message is stored here.
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

// No objects with destructors here (see Source). Both steps return false if libpng failed.
bool read_header(const Reader& r, Source& source) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_set_read_fn(r.png, &source, take_bytes);
  // read_png has its own limit and message.
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

void open(Source& source, const std::filesystem::path& path) {
  check_input_file(path, {path.string()});
  errno = 0;
  source.file.open(path, std::ios::binary);
  if (!source.file) {
    refuse_file(path, "cannot be read: " + system_reason(errno));
  }
  png_byte signature[8] = {};
  source.file.read(reinterpret_cast<char*>(signature), sizeof signature);
  if (!source.file || png_sig_cmp(signature, 0, sizeof signature) != 0) {
    refuse_file(path, "is not a PNG file", "photographs are read as PNG",
                "Convert it, for example with convert photo.jpg photo.png");
  }
  source.file.seekg(0);
}

}  // namespace

namespace {

// bytes: rows of equal length, numbers of 16 bits with the high byte first.
void write_rows(const std::filesystem::path& path, Picture picture, std::span<const png_byte> bytes,
                const Texts& text) {
  std::vector<const png_byte*> rows(picture.height);
  const std::size_t stride = bytes.size() / picture.height;
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = bytes.data() + y * stride;
  const std::vector<png_text> chunks = text_chunks(text);
  picture.rows = rows.data();
  picture.text = chunks.data();
  picture.text_count = static_cast<int>(chunks.size());

  Sink sink;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, keep_message, ignore_warning);
  if (png == nullptr) throw std::bad_alloc();
  png_infop info = png_create_info_struct(png);
  bool encoded = false;
  if (info != nullptr) {
    png_set_write_fn(png, &sink, append_bytes, flush_nothing);
    encoded = encode(png, info, picture);
  }
  png_destroy_write_struct(&png, &info);
  if (!encoded) {
    throw Error(Blame::Work, path.string(),
                std::string("cannot be written: ") +
                    (sink.message[0] != '\0' ? sink.message : "out of memory"));
  }
  write_text(path, sink.bytes);
}

}  // namespace

void write_png(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const std::uint8_t> pixels, const Texts& text) {
  if (width < 1 || height < 1 || (channels != 1 && channels != 3)) {
    throw Error(Blame::Work, path.string(),
                "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " with " + std::to_string(channels) + " channels was to be written",
                "PNG pictures here have at least one pixel and 1 or 3 channels");
  }
  if (another_rank_writes()) return;
  const std::size_t stride = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  if (pixels.size() != stride * static_cast<std::size_t>(height)) {
    throw Error(Blame::Work, path.string(), "the pixel count does not match the picture's size");
  }
  write_rows(path,
             {static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
              channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, 8, nullptr, nullptr, 0},
             pixels, text);
}

void write_png16(const std::filesystem::path& path, int width, int height,
                 std::span<const std::uint16_t> pixels) {
  if (width < 1 || height < 1 ||
      pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw Error(Blame::Work, path.string(), "the pixel count does not match the picture's size");
  }
  if (another_rank_writes()) return;
  std::vector<png_byte> bytes;
  bytes.reserve(2 * pixels.size());
  for (const std::uint16_t value : pixels) {
    bytes.push_back(static_cast<png_byte>(value >> 8));
    bytes.push_back(static_cast<png_byte>(value & 255));
  }
  write_rows(path,
             {static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
              PNG_COLOR_TYPE_GRAY, 16, nullptr, nullptr, 0},
             bytes, {});
}

Picture8 read_png(const std::filesystem::path& path) {
  Source source;
  open(source, path);
  const auto broken = [&] {
    if (source.message[0] == '\0') throw std::bad_alloc();
    refuse_file(path, std::string("is a broken PNG file: ") + source.message, {},
                "Save the picture once more");
  };
  const Reader reader(source);
  if (reader.info == nullptr) throw std::bad_alloc();
  if (!read_header(reader, source)) broken();
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  if (width > largest_png_edge_px || height > largest_png_edge_px) {
    refuse_file(path, "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
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
