// SPDX-License-Identifier: Apache-2.0
// Files that a scene names: read whole, bounded in size, and kept inside the folders they belong
// to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

namespace earthshine::scenes {

// The bytes of a file of at most max_bytes. asked_at is the place that names the file; an error
// stands there. Throws base::Error (Input) if it is missing, a folder, unreadable or larger.
[[nodiscard]] std::string read_input_file(const std::filesystem::path& path, std::size_t max_bytes,
                                          const base::Location& asked_at);

// The same, of a file on disk only: a pipe or a device, which may keep the reader waiting for ever,
// is refused.
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& path,
                                            std::size_t max_bytes, const base::Location& asked_at);

// A file that another file names by a relative path, which may not lead out of the given folders: a
// mesh from elsewhere must not make the program read files it has no business with. Throws
// base::Error (Input) at asked_at if `named` is absolute or leads out of all of them.
[[nodiscard]] std::filesystem::path confined_path(const std::filesystem::path& base_folder,
                                                  std::string_view named,
                                                  std::span<const std::filesystem::path> folders,
                                                  const base::Location& asked_at);

}  // namespace earthshine::scenes
