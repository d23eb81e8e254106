// SPDX-License-Identifier: Apache-2.0
// Checks the header of an OpenEXR file before the library reads it. The library would allocate two
// gigabytes for an attribute that a file of three kilobytes announces.
#pragma once

#include <filesystem>

namespace earthshine::base {

// Throws base::Error (Input) if an attribute or an offset table is larger than the file, or if the
// size of an attribute does not match its type, which would make the library read on at a wrong
// position. Other files, and files that end in the header, pass: the library reports them.
void guard_exr(const std::filesystem::path& path);

}  // namespace earthshine::base
