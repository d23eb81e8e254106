// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ and MTL. Own readers: the subset is small, every error has its line and column, and
// the usual library enlarges the area of concave polygons.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads v, f, g, o, usemtl, mtllib, and vt and vn if needed. Ignores s, l, p and curves; unknown
// keywords give one warning each. Libraries are recorded but not read; their paths must stay in the
// folders.
[[nodiscard]] Mesh parse_obj(std::string_view text, const std::filesystem::path& path,
                             std::span<const std::filesystem::path> folders,
                             VertexNormals normals = VertexNormals::Sides);

// Reads Kd, Ks, Ns, Ke, d, Tr, Tf, Ni and illum, mapped as in docs/models.md. One warning names all
// other properties that would change the picture; the rest is ignored. Textures (mtl_maps.h) lie
// beside the library or in the folders.
void parse_mtl(std::string_view text, const std::filesystem::path& path,
               std::span<const std::filesystem::path> folders, Mesh& mesh);

// Adds all pictures that lines of mesh.libraries reference to mesh.files, read or not, so that no
// output overwrites them.
void list_map_files(Mesh& mesh, std::span<const std::filesystem::path> folders);

// Reads mesh.libraries into mesh.materials and empties the list.
void read_material_libraries(Mesh& mesh, std::span<const std::filesystem::path> folders);

}  // namespace earthshine::scenes
