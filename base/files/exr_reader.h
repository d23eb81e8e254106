// SPDX-License-Identifier: Apache-2.0
// Reads the picture of any linear OpenEXR file in blocks of rows.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/files/exr_file.h"

namespace earthshine::base {

// The picture of a file:
//   part      the first flat part with a picture, else the first part
//   channels  R, G, B (or r, g, b, or red, green, blue), else X, Y, Z, else Y (or luminance, L).
//             They are in the root, or in the only layer that has them, or in the only layer
//             called Combined. Alpha and all other channels are ignored: the colours of
//             OpenEXR are premultiplied and are already the light of the pixel.
//   colours   XYZ and other chromaticities are converted to Rec. 709 by a matrix, without
//             adaptation of the white point
//   unit      cd/m^2: values times whiteLuminance
//   window    intersection of data window and display window (exr_window.h);
//             header().whole has its position, for crops
// Half, float and integer channels, scan lines or tiles, all compressions of the library.
class ExrReader {
 public:
  // Reads the header and checks that all pixels are stored. Throws base::Error (Input) for a file
  // that is missing, broken, incomplete or deep; without such channels (the message lists its
  // channels), with several candidate layers or with channels of reduced resolution; without a
  // pixel in the display window; with pixels that are not square; with more than 65536 pixels on an
  // edge or 2^30 in all.
  explicit ExrReader(const std::filesystem::path& path);
  ~ExrReader();
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  [[nodiscard]] int channel_count() const;  // 3: R, G, B; 1: Y
  [[nodiscard]] const ExrHeader& header() const;

  // Rows [first, first + count) as R, G, B or Y. Throws base::Error (Input) for broken data and for
  // a NaN or infinite pixel, with its position.
  [[nodiscard]] Image read_rows(int first, int count);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace earthshine::base
