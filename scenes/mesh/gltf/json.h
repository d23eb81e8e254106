// SPDX-License-Identifier: Apache-2.0
// The text of a glTF file, before tinygltf sees it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::scenes {

// Checks all values that are read against the specification, because tinygltf silently uses the
// default for a value of the wrong type or length. A wrong type, or a value out of range without a
// clear meaning, is an error that names its place (base::Error, Input). Other values out of range
// give one warning per kind that states the replacement. `bytes`: of a .gltf or .glb file. Returns
// corrected bytes if integers are written as "1.0", which is allowed but which tinygltf rejects.
[[nodiscard]] std::optional<std::string> check_gltf_text(std::string_view bytes,
                                                         const std::filesystem::path& path,
                                                         std::vector<std::string>& warnings);

}  // namespace earthshine::scenes
