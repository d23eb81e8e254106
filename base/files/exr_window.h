// SPDX-License-Identifier: Apache-2.0
// Window of an OpenEXR file that is its picture, and reading this window. For exr_file.cpp and
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

// Intersection of the display window (the picture) and the data window (the stored pixels;
// "Technical Introduction to OpenEXR"). Pixels outside the display window are overscan and are
// ignored. Throws base::Error (Input) if the windows do not intersect.
[[nodiscard]] Imath::Box2i picture_window(const std::filesystem::path& path,
                                          const Imf::Header& header);

// The display window and the position of picture_window in it; columns = 0 if they are equal, which
// means that the file has the whole picture.
[[nodiscard]] ExrHeader::Whole whole_of(const Imf::Header& header, const Imath::Box2i& window);

// Rows [first, first + count) of the window. One float channel for each name in `channels`.
[[nodiscard]] Image read_window(Imf::MultiPartInputFile& file, int part,
                                const std::vector<std::string>& channels,
                                const Imath::Box2i& window, int first, int count);

}  // namespace earthshine::base
