// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ and MTL. Own readers: the subset is small, every error gets its line and column,
// and the usual library multiplies the area of concave polygons.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// Reads v, f, g, o, usemtl, mtllib, and where they are of use vt and vn; knows and passes over s,
// l, p and curves; keywords that nobody knows give one warning each. Libraries are noted, not read;
// their paths must stay in the folders.
[[nodiscard]] Mesh parse_obj(std::string_view text, const std::filesystem::path& path,
                             std::span<const std::filesystem::path> folders,
                             VertexNormals normals = VertexNormals::Sides);

// Kd, Ks, Ns, Ke, d, Tr, Tf, Ni and illum as docs/models.md maps them; whatever else would change
// the picture is named in one warning, the rest is passed over. Textures (mtl_maps.h) lie beside
// the library or in the folders.
void parse_mtl(std::string_view text, const std::filesystem::path& path,
               std::span<const std::filesystem::path> folders, Mesh& mesh);

// Adds the pictures that lines of mesh.libraries name to mesh.files, whether they are read here or
// not: nobody wants them written over.
void list_map_files(Mesh& mesh, std::span<const std::filesystem::path> folders);

// Reads mesh.libraries into mesh.materials and empties the list.
void read_material_libraries(Mesh& mesh, std::span<const std::filesystem::path> folders);

}  // namespace earthshine::scenes
