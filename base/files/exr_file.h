// SPDX-License-Identifier: Apache-2.0
// Reads and writes OpenEXR. Only this file, exr_reader and their helpers use the library.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"

namespace earthshine::base {

// 4 x 4 matrix in row-major order, for row vectors as in OpenEXR: (x, y, z, 1) M.
using ExrMatrix = std::array<float, 16>;

// Header attributes. Standard attributes (focus, screenWindowWidth, worldToCamera ...) use their
// standard names.
struct ExrHeader {
  std::vector<std::pair<std::string, std::string>> text;
  std::vector<std::pair<std::string, float>> numbers;
  std::vector<std::pair<std::string, ExrMatrix>> matrices = {};
  // The display window: size of the whole picture and position of the image's top left pixel in it.
  // columns = 0: the image is the whole picture.
  struct Whole {
    int columns = 0, rows = 0, x = 0, y = 0;
  } whole = {};
  // Channels to write in 16 bits, rounded to the nearest half. Not filled by read_exr.
  std::vector<std::string> half_channels = {};
};

struct ExrFile {
  Image image;
  ExrHeader header;
};

// Writes float channels, or half channels where the header says so, ZIP compressed, with Rec. 709
// chromaticities and whiteLuminance = 1 (pixels are radiance in cd/m^2). Writes a temporary file
// and renames it, so that a failure keeps the older file. Throws base::Error (Work) if the file
// cannot be written.
void write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& header = {});

// Reads all channels of a scan-line or tiled file as float; of a multi-part file, the first part.
// The image is the intersection of data window and display window; header.whole has its position in
// the picture. R, G, B and Y are multiplied by whiteLuminance, which gives cd/m^2. Channel names
// are unchanged. Throws base::Error (Input) if the file is missing, broken, incomplete, deep or
// larger than 16384 x 16384, if the two windows do not intersect, or if R, G, B or Y is NaN or
// infinite somewhere (the message has the first such pixel).
[[nodiscard]] ExrFile read_exr(const std::filesystem::path& path);

}  // namespace earthshine::base
