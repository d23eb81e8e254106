// SPDX-License-Identifier: Apache-2.0
// include = ["FILE.toml", ...]: tables that a scene shares with others.
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/text/toml_file.h"

namespace earthshine::scenes {

// Takes "include" out of a scene's tree and puts the tables of these files into it: entries of
// [[material]] and its like before the scene's own, of which one with the same name replaces them;
// [sun] and its like where the scene has none. Their file names become relative to the scene. The
// files may include others in turn; all are added to `files`. Throws base::Error (Input) where the
// files are named for what is no list of them, for a file that includes itself, and for one in
// another unit of length.
void add_includes(TomlNode& tree, const std::filesystem::path& scene,
                  std::vector<std::filesystem::path>& files);

}  // namespace earthshine::scenes
