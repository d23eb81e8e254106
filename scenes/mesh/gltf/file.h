// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB by tinygltf, which validates little. This file protects it from deep JSON,
// foreign paths and images, and validates accessors and node trees.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

inline constexpr int max_json_depth = 64;
inline constexpr int max_node_depth = 64;
// Limit over all instances: several nodes may use one mesh.
inline constexpr std::size_t max_gltf_triangles = std::size_t{1} << 24;

// Triangles of the default scene (else the first scene, else all root nodes) with the nodes'
// transforms applied. Parts: names of meshes, and names of nodes with all their descendants.
// Materials and textures: materials.h.
[[nodiscard]] Mesh parse_gltf(std::string_view bytes, const std::filesystem::path& path,
                              std::span<const std::filesystem::path> folders,
                              VertexNormals normals = VertexNormals::Sides);

}  // namespace earthshine::scenes
