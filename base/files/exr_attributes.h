// SPDX-License-Identifier: Apache-2.0
// Between ExrHeader and the library's own header. For exr_file.cpp alone.
#pragma once

#include <ImathBox.h>
#include <ImfHeader.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/exr_file.h"

namespace earthshine::base {

// Sets ZIP compression, Rec. 709 chromaticities, whiteLuminance = 1 and all of `attributes`.
void set_exr_attributes(Imf::Header& header, const ExrHeader& attributes);

// Text, numbers (whole ones and doubles as float) and 4 x 4 matrices of a file, so that they can be
// written again: not what describes the storage or is set by set_exr_attributes.
[[nodiscard]] ExrHeader exr_attributes(const Imf::Header& header);

// 1 unless the file says otherwise. Throws base::Error (Input) when it is not positive.
[[nodiscard]] float white_luminance(const std::filesystem::path& path, const Imf::Header& header);

// Each throws base::Error (Input): for a file that is not there, no file on disk, or announces more
// than it holds; one of deep data; one whose value i, in rows of `columns` from row `first` on, is
// NaN or infinite.
void check_exr_file(const std::filesystem::path& path);
[[nodiscard]] bool is_deep(const Imf::Header& header);
void refuse_deep(const std::filesystem::path& path, const Imf::Header& header);
[[noreturn]] void refuse_pixel(const std::filesystem::path& path, const std::string& channel,
                               std::size_t i, int columns, int first, float value);

// Which of a file's channels are its picture.

struct ExrPicture {
  enum class Kind { None, Rgb, Xyz, Luminance };
  Kind kind = Kind::None;
  std::vector<std::string> channels;  // three or one, as the file names them
  std::vector<std::string> layers;    // kind = None: several that could be meant
};
// As exr_reader.h has it.
[[nodiscard]] ExrPicture find_picture(const std::vector<std::string>& channels);

}  // namespace earthshine::base
