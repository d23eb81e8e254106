// SPDX-License-Identifier: Apache-2.0
// Converts between ExrHeader and the header of OpenEXR. Only for exr_file.cpp and exr_reader.cpp.
#pragma once

#include <ImathBox.h>
#include <ImfHeader.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/exr_file.h"

namespace earthshine::base {

// Sets ZIP compression, Rec. 709 chromaticities, whiteLuminance = 1 and all `attributes`.
void set_exr_attributes(Imf::Header& header, const ExrHeader& attributes);

// Text, numbers (integers and doubles as float) and 4 x 4 matrices of a file, for rewriting.
// Excludes attributes of the storage and those that set_exr_attributes sets.
[[nodiscard]] ExrHeader exr_attributes(const Imf::Header& header);

// whiteLuminance, cd/m^2; 1 by default. Throws base::Error (Input) if it is not positive.
[[nodiscard]] float white_luminance(const std::filesystem::path& path, const Imf::Header& header);

// Each throws base::Error (Input).
// check_exr_file: the file is missing, not on disk, a PNG, or its header exceeds the file.
// refuse_deep: deep data.
// refuse_pixel: value i is NaN or infinite. Rows have `columns` values and start at row `first`.
void check_exr_file(const std::filesystem::path& path);
[[nodiscard]] bool is_deep(const Imf::Header& header);
void refuse_deep(const std::filesystem::path& path, const Imf::Header& header);
[[noreturn]] void refuse_pixel(const std::filesystem::path& path, const std::string& channel,
                               std::size_t i, int columns, int first, float value);

// Selection of the picture's channels.

struct ExrPicture {
  enum class Kind { None, Rgb, Xyz, Luminance };
  Kind kind = Kind::None;
  std::vector<std::string> channels;  // three or one, under their names in the file
  std::vector<std::string> layers;    // kind = None: candidates, if several
};
// The rules are in exr_reader.h.
[[nodiscard]] ExrPicture find_picture(const std::vector<std::string>& channels);

}  // namespace earthshine::base
