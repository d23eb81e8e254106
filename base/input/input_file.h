// SPDX-License-Identifier: Apache-2.0
// Input files: regular files of bounded size only. Pipes and devices may block or never end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace earthshine::base {

// For readers that open a file by name. asked_at: the place that names the file, for errors. Throws
// base::Error (Input) if the file is missing or not a regular file.
void check_input_file(const std::filesystem::path& path, const Location& asked_at);

// Contents of a regular file of at most max_bytes. Throws base::Error (Input) at asked_at if it is
// missing, a folder, a pipe, a device, unreadable or larger. Throws base::Error (Work) if memory is
// short.
[[nodiscard]] std::string read_input_file(const std::filesystem::path& path, std::size_t max_bytes,
                                          const Location& asked_at);

// Throws base::Error (Input) for a file whose contents are invalid.
[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& found,
                              std::string_view allowed = {}, std::string_view remedy = {});

}  // namespace earthshine::base
