// SPDX-License-Identifier: Apache-2.0
// include = ["FILE.toml", ...]: tables that a scene shares with others.
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/text/toml_file.h"

namespace earthshine::scenes {

// Replaces "include" in a scene's tree by the tables of the included files. Entries of [[material]]
// and other lists come before the scene's own; an own entry with the same name replaces them. [sun]
// and other tables are added if the scene has none. File names become relative to the scene.
// Included files may include others; all are added to `files`. Throws base::Error (Input) if the
// value is not a list of files, for a file that includes itself, and for another unit of length.
void add_includes(TomlNode& tree, const std::filesystem::path& scene,
                  std::vector<std::filesystem::path>& files);

}  // namespace earthshine::scenes
