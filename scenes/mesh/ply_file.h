// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: ascii and binary, polygons.
#pragma once

#include <filesystem>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads x, y, z (and nx, ny, nz) of element "vertex" and vertex_indices (or vertex_index) of
// element "face"; passes over other elements and properties. PLY has neither parts nor materials.
[[nodiscard]] Mesh parse_ply(std::string_view bytes, const std::filesystem::path& path,
                             VertexNormals normals = VertexNormals::Sides);

}  // namespace earthshine::scenes
