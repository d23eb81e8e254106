// SPDX-License-Identifier: Apache-2.0
// What a glTF file holds besides triangles and plain materials. Only the files that own tinygltf
// include this.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace earthshine::scenes {

// Vertex attributes but for positions and coordinates of textures, lamps, cameras, skins,
// animations, extensions that nothing here knows.
[[nodiscard]] std::map<std::string, std::size_t> unused_of(const tinygltf::Model& model);

// Throws base::Error (Input) for an extension that the file cannot be read without, with what
// turns it into a file without. Those that concern textures alone are no hindrance.
void check_required_extensions(const tinygltf::Model& model, const std::filesystem::path& path);

}  // namespace earthshine::scenes
