// SPDX-License-Identifier: Apache-2.0
// The picture of any linear OpenEXR file, as much of it at a time as one wants.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/files/exr_file.h"

namespace earthshine::base {

// What becomes the picture:
//   part      the first flat part that has a picture, else the first
//   channels  R, G, B (also r, g, b and red, green, blue) or X, Y, Z or Y (also luminance, L); of
//   the
//             file itself, or of its only layer that has them, or of the only one called Combined.
//             Alpha is left out: OpenEXR's colours are premultiplied, they are the light that comes
//             from the pixel. Everything else is left out too.
//   colours   chromaticities other than Rec. 709 and XYZ are brought to Rec. 709 by their matrix,
//             without adapting the white
//   unit      cd/m^2: values times whiteLuminance
//   window    the pixels of the data window that lie in the display window (exr_window.h).
//             header().whole tells a crop from a whole picture.
// Half, float and whole numbers, scan lines or tiles, any compression of the library.
class ExrReader {
 public:
  // Reads the header alone, and makes sure that the pixels are there. Throws base::Error (Input):
  // missing, broken, incomplete, deep; no such channels (with those that it has) or several layers
  // of them; channels of reduced resolution; no pixel in the display window; pixels that are not square; more than 65536 on an edge
  // or 2^30 pixels.
  explicit ExrReader(const std::filesystem::path& path);
  ~ExrReader();
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  [[nodiscard]] int channel_count() const;  // 3: R, G, B; 1: Y
  [[nodiscard]] const ExrHeader& header() const;

  // Rows [first, first + count): R, G, B or Y. Throws base::Error (Input) for broken data and for a
  // pixel that is NaN or infinite, with its place in the picture.
  [[nodiscard]] Image read_rows(int first, int count);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace earthshine::base
