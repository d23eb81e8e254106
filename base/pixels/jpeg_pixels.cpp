// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstdio>
// jpeglib.h needs the two headers above.
#include <jpeglib.h>

#include <string>

#include "base/error.h"
#include "base/pixels/pixels.h"

namespace earthshine::base {
namespace {

// libjpeg reports errors by a function that must not return, hence by longjmp, which must not skip
// a destructor. read_jpeg_pixels owns all objects with destructors; the steps have none.
struct JpegErrors {
  jpeg_error_mgr manager{};
  std::jmp_buf back{};
  char message[JMSG_LENGTH_MAX] = {};
};

extern "C" {
static void leave_jpeg(j_common_ptr jpeg) {
  auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
  jpeg->err->format_message(jpeg, errors->message);
  std::longjmp(errors->back, 1);
}
static void ignore_jpeg_message(j_common_ptr) {}
}

struct JpegReader {
  JpegErrors errors;
  jpeg_decompress_struct jpeg{};
  JpegReader() {
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = leave_jpeg;
    errors.manager.output_message = ignore_jpeg_message;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
};

bool begin(JpegReader& r, const unsigned char* bytes, unsigned long size) {
  if (setjmp(r.errors.back) != 0) return false;
  jpeg_create_decompress(&r.jpeg);
  jpeg_mem_src(&r.jpeg, bytes, size);
  jpeg_read_header(&r.jpeg, TRUE);
  r.jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_calc_output_dimensions(&r.jpeg);
  return true;
}

bool read(JpegReader& r, std::uint8_t* rgba) {
  if (setjmp(r.errors.back) != 0) return false;
  jpeg_start_decompress(&r.jpeg);
  while (r.jpeg.output_scanline < r.jpeg.output_height) {
    JSAMPROW row = rgba + std::size_t{4} * r.jpeg.output_width * r.jpeg.output_scanline;
    jpeg_read_scanlines(&r.jpeg, &row, 1);
  }
  jpeg_finish_decompress(&r.jpeg);
  return true;
}

}  // namespace

Pixels read_jpeg_pixels(std::string_view bytes, std::string_view named) {
  JpegReader reader;
  const auto refuse = [&](const std::string& why) {
    throw Error(Blame::Input, named, "is a broken JPEG file: " + why, {},
                "Save the picture once more, as RGB or grey");
  };
  if (!begin(reader, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) {
    refuse(reader.errors.message);
  }
  check_size(reader.jpeg.output_width, reader.jpeg.output_height, named);
  Pixels pixels{
      static_cast<int>(reader.jpeg.output_width), static_cast<int>(reader.jpeg.output_height), {}};
  pixels.rgba.resize(std::size_t{4} * reader.jpeg.output_width * reader.jpeg.output_height);
  if (!read(reader, pixels.rgba.data())) refuse(reader.errors.message);
  // libjpeg fills a truncated file with grey and only warns.
  if (reader.errors.manager.num_warnings > 0) refuse("it is cut short or damaged");
  return pixels;
}

}  // namespace earthshine::base
