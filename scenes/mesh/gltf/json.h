// SPDX-License-Identifier: Apache-2.0
// The text of a glTF file, before tinygltf sees it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::scenes {

// Where tinygltf finds a value of another type than it looks for, or of another length, it takes
// the default without a word. So every value that the readers here use is held against the
// specification: of the wrong type, or outside its range where nobody can tell what is meant, it is
// refused by its place (base::Error, Input); else it is named in a warning, one for each kind, with
// what is done about it. `bytes`: of a .gltf or .glb file. Gives the bytes to read instead, if
// whole numbers stand there as "1.0": they may, and tinygltf does not know them.
[[nodiscard]] std::optional<std::string> check_gltf_text(std::string_view bytes,
                                                         const std::filesystem::path& path,
                                                         std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
