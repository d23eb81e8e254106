// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB through tinygltf, which checks little: this file keeps it from what it cannot
// digest (deep JSON, foreign paths, images) and checks what it accepts (accessors, node trees).
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

inline constexpr int max_json_depth = 64;
inline constexpr int max_node_depth = 64;
// Over all instances: a mesh may hang on many nodes.
inline constexpr std::size_t max_gltf_triangles = std::size_t{1} << 24;

// The triangles of the default scene (or the first, or all root nodes), with the nodes' transforms
// applied. Parts: names of nodes, each with what hangs below it, and of meshes. Materials and
// textures: materials.h.
[[nodiscard]] Mesh parse_gltf(std::string_view bytes, const std::filesystem::path& path,
                              std::span<const std::filesystem::path> folders,
                              VertexNormals normals = VertexNormals::Sides);

}  // namespace earthshine::scenes
