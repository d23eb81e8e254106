// SPDX-License-Identifier: Apache-2.0
// Which pixels of an OpenEXR file are its picture, and reading these alone. For exr_file.cpp and
// exr_reader.cpp.
#pragma once

#include <ImathBox.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/exr_file.h"

namespace earthshine::base {

// The display window is the picture and the data window holds the pixels that are stored
// ("Technical Introduction to OpenEXR"): the picture's stored pixels are the intersection. What the
// data window has beyond a border of the display window is overscan, which nobody sees. Throws
// base::Error (Input) where the two have no pixel in common.
[[nodiscard]] Imath::Box2i picture_window(const std::filesystem::path& path,
                                          const Imf::Header& header);

// The display window and where in it the picture_window begins; without columns if the two are the
// same, so that the file has the whole picture.
[[nodiscard]] ExrHeader::Whole whole_of(const Imf::Header& header, const Imath::Box2i& window);

// Rows [first, first + count) of the window, its columns alone. Of each channel a float image by
// the file's name for it.
[[nodiscard]] Image read_window(Imf::MultiPartInputFile& file, int part,
                                const std::vector<std::string>& channels,
                                const Imath::Box2i& window, int first, int count);

}  // namespace earthshine::base
