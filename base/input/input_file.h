// SPDX-License-Identifier: Apache-2.0
// Files that are read: on disk alone, since a pipe or a device may keep the reader waiting for ever
// or never end, and bounded in size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace earthshine::base {

// For readers that open a file by its name. asked_at is the place that names the file; an error
// stands there. Throws base::Error (Input) for what is missing or no file on disk.
void check_input_file(const std::filesystem::path& path, const Location& asked_at);

// The bytes of a file on disk of at most max_bytes. Throws base::Error (Input) at asked_at if it is
// missing, a folder, a pipe, a device, unreadable or larger, and base::Error (Work) where there is
// not the memory for it.
[[nodiscard]] std::string read_input_file(const std::filesystem::path& path, std::size_t max_bytes,
                                          const Location& asked_at);

// Throws base::Error (Input) of a file whose contents cannot be read.
[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& found,
                              std::string_view allowed = {}, std::string_view remedy = {});

}  // namespace earthshine::base
