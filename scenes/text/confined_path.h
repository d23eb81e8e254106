// SPDX-License-Identifier: Apache-2.0
// Confines files that a mesh references to the permitted folders.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "base/error.h"

namespace earthshine::scenes {

// Resolves a relative path in a file, which must not leave the given folders: a foreign mesh must
// not make the program read unrelated files. Throws base::Error (Input) at asked_at if `named` is
// absolute or leaves all of them.
[[nodiscard]] std::filesystem::path confined_path(const std::filesystem::path& base_folder,
                                                  std::string_view named,
                                                  std::span<const std::filesystem::path> folders,
                                                  const base::Location& asked_at);

}  // namespace earthshine::scenes
