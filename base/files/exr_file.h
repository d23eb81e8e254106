// SPDX-License-Identifier: Apache-2.0
// Reading and writing OpenEXR. The only user of the library, with exr_reader and their helpers.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"

namespace earthshine::base {

// Four rows of four, for points as rows as OpenEXR has it: (x, y, z, 1) M.
using ExrMatrix = std::array<float, 16>;

// Attributes of the header. A standard attribute (focus, screenWindowWidth, worldToCamera ...) goes
// by its standard name.
struct ExrHeader {
  std::vector<std::pair<std::string, std::string>> text;
  std::vector<std::pair<std::string, float>> numbers;
  std::vector<std::pair<std::string, ExrMatrix>> matrices = {};
  // The picture that the image is a part of (the display window), and where its top left pixel lies
  // in it; without columns the image is the whole.
  struct Whole {
    int columns = 0, rows = 0, x = 0, y = 0;
  } whole = {};
  // Channels to be written in 16 bits, rounded to the nearest half; not read back.
  std::vector<std::string> half_channels = {};
};

struct ExrFile {
  Image image;
  ExrHeader header;
};

// Writes 32-bit float channels, or 16-bit ones where the header says so, ZIP compressed, with Rec.
// 709 chromaticities and whiteLuminance = 1 (pixels are radiance in cd/m^2). Written aside and
// renamed: a failure leaves an older file whole. Throws base::Error (Work) when the file cannot be
// written.
void write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& header = {});

// Reads every channel of a scan-line or tiled file as float (of a multi-part file the first part);
// the pixels of the data window that lie in the display window become the image, and header.whole
// says of which picture they are a part. A whiteLuminance attribute is applied to R, G, B and Y, so
// that they are cd/m^2. Channel names are kept. Throws base::Error (Input) for a missing, broken,
// incomplete, deep or larger than 16384 x 16384 file, where no pixel lies in the display window, and when R, G, B or Y has a pixel that is NaN
// or infinite (with the first pixel's position).
[[nodiscard]] ExrFile read_exr(const std::filesystem::path& path);

}  // namespace earthshine::base
