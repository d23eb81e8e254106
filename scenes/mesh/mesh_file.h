// SPDX-License-Identifier: Apache-2.0
// Reads mesh files (OBJ/MTL, glTF/GLB, PLY, STL), by file extension.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads a mesh whose name is written at asked_at. Files that it references (MTL, glTF buffers) must
// lie in or below scene_folder or the mesh's own folder. In the result every index is in range and
// every coordinate finite. Throws base::Error (Input) with the mesh's own file and, for text
// formats, line and column; for a missing file or an unknown extension, at asked_at.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path,
                             const std::filesystem::path& scene_folder,
                             const base::Location& asked_at,
                             VertexNormals normals = VertexNormals::Sides);

// Index of the part with this name. Throws base::Error (Input) at asked_at, with the nearest name
// and the list of names, if there is none.
[[nodiscard]] std::uint32_t find_part(const Mesh& mesh, const std::string& part,
                                      const base::Location& asked_at);

// Index in mesh.materials of the material with this name; reads the mesh's libraries if necessary.
// no_index if it is not defined.
[[nodiscard]] std::uint32_t find_mesh_material(Mesh& mesh, const std::string& name,
                                               const std::filesystem::path& scene_folder);

}  // namespace earthshine::scenes
