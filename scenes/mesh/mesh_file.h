// SPDX-License-Identifier: Apache-2.0
// Mesh files to meshes: OBJ/MTL, glTF/GLB, PLY, STL, by the file's ending.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads a mesh whose name stands at asked_at. Files that it names in turn (MTL, glTF buffers) must
// lie in scene_folder or in the mesh's own folder, or below. Every index of the result is in range,
// every coordinate finite. Throws base::Error (Input) with the mesh's own file and, for text
// formats, line and column; for a missing file or an unknown ending, at asked_at.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path,
                             const std::filesystem::path& scene_folder,
                             const base::Location& asked_at,
                             VertexNormals normals = VertexNormals::Sides);

// The number of the part of that name.
// Throws base::Error (Input) at asked_at, with the nearest name and the list, if there is none.
[[nodiscard]] std::uint32_t find_part(const Mesh& mesh, const std::string& part,
                                      const base::Location& asked_at);

// The number in mesh.materials of the material of that name, after reading the libraries that the
// mesh names if need be; no_index if nobody defines it.
[[nodiscard]] std::uint32_t find_mesh_material(Mesh& mesh, const std::string& name,
                                               const std::filesystem::path& scene_folder);

}  // namespace earthshine::scenes
