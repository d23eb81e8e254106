// SPDX-License-Identifier: Apache-2.0
// Stanford PLY: ascii and binary, polygons and triangle strips.
#pragma once

#include <filesystem>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads x, y, z (and nx, ny, nz) of element "vertex" and vertex_indices (or vertex_index) of the
// elements "face" and "tristrips"; ignores other elements and properties. In a list of "tristrips",
// -1 begins a new strip. The first triangle of a strip has the winding of its corners, every second
// one the opposite; triangles with a repeated corner only join strips and are omitted. PLY has
// neither parts nor materials.
[[nodiscard]] Mesh parse_ply(std::string_view bytes, const std::filesystem::path& path,
                             VertexNormals normals = VertexNormals::Sides);

}  // namespace earthshine::scenes
