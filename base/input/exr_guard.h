// SPDX-License-Identifier: Apache-2.0
// What the header of an OpenEXR file announces, looked at before the library believes it: an
// attribute of two gigabytes in a file of three kilobytes would be made room for.
#pragma once

#include <filesystem>

namespace earthshine::base {

// Throws base::Error (Input) where an attribute or a table of chunks is larger than the file, or an
// attribute's size is not that of its type, so that the library would read on elsewhere than where
// it ends. What is no OpenEXR file, or breaks off, is left for the library to name.
void guard_exr(const std::filesystem::path& path);

}  // namespace earthshine::base
