// SPDX-License-Identifier: Apache-2.0
// Files that a mesh names, kept inside the folders they belong to.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "base/error.h"

namespace earthshine::scenes {

// A file that another file names by a relative path, which may not lead out of the given folders: a
// mesh from elsewhere must not make the program read files it has no business with. Throws
// base::Error (Input) at asked_at if `named` is absolute or leads out of all of them.
[[nodiscard]] std::filesystem::path confined_path(const std::filesystem::path& base_folder,
                                                  std::string_view named,
                                                  std::span<const std::filesystem::path> folders,
                                                  const base::Location& asked_at);

}  // namespace earthshine::scenes
