// SPDX-License-Identifier: Apache-2.0
// A mesh as read from its file (or made by a shape): polygons in the file's own coordinates, before
// any transform.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

inline constexpr std::uint32_t no_index = 0xFFFFFFFFU;
inline constexpr std::size_t max_mesh_bytes = std::size_t{512} << 20;
inline constexpr std::size_t max_polygon_corners = 1024;
// Larger coordinates are typing errors. Their squares would be accurate, the scene would not.
inline constexpr double largest_coordinate = 1e15;

struct MeshPolygon {
  std::uint32_t first = 0;  // into Mesh::indices
  std::uint32_t count = 0;
  std::uint32_t part_set = 0;         // into Mesh::part_sets
  std::uint32_t material = no_index;  // into Mesh::material_names
  std::uint32_t line = 0;             // of the file; 0: unknown
};

// A material library that an OBJ file names. It is read when the scene lacks a material.
struct MaterialLibrary {
  std::string named;
  base::Location where;
};

// Entries of Mesh::unused for lamps and cameras. An object can import them.
inline constexpr const char* lamps_of_file = "lights";
inline constexpr const char* cameras_of_file = "cameras";
// Lamps and cameras that no object can import.
inline constexpr const char* unknown_lamps_of_file = "lights of an unknown type";
inline constexpr const char* flat_cameras_of_file = "orthographic cameras";

// A lamp or a camera in the mesh file, in the file's own coordinates. Names may be empty or
// repeated.
struct MeshLamp {
  Lamp lamp;
  std::uint32_t part_set = 0;
};
struct MeshCamera {
  Camera camera;
  std::uint32_t part_set = 0;
};

// Use of vertex normals. Sides: they identify the front; faulty normals are ignored. Shape: they
// define a curved surface; faulty normals are an error.
enum class VertexNormals { Sides, Shape };

// Names of normals in OBJ, PLY and glTF files, for Mesh::unused.
inline constexpr std::string_view normals_of_file[] = {"vn", "nx", "ny", "nz", "NORMAL"};

struct Mesh {
  std::filesystem::path path;    // empty for a shape
  std::optional<double> metres;  // metres per unit of length; no value: the scene's unit
  bool is_y_up = false;          // set by the format; false: the format does not define it
  bool is_own = false;           // written by this program, which rotated z up to y up
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;     // counter-clockwise seen from the front
  std::vector<glm::vec2> uv;              // texture coordinates, v down from the upper edge
  std::vector<std::uint32_t> uv_indices;  // into uv, one for each of `indices`; no_index: none.
                                          // Empty: no corner has any
  // Each as long as uv, or empty: second texture coordinates, and factors on the diffuse colour.
  std::vector<glm::vec2> second_uv;
  std::vector<glm::vec3> colours;
  std::vector<glm::vec3> normals;             // of the surface; 0 where the file's normal is faulty
  std::vector<std::uint32_t> normal_indices;  // as uv_indices
  std::vector<MeshPolygon> polygons;
  std::vector<std::string> part_names;                // groups, objects, nodes, meshes, solids
  std::vector<std::vector<std::uint32_t>> part_sets;  // a polygon may belong to several
  std::vector<std::string> material_names;
  std::vector<Material> materials;              // defined by the file or a library
  std::vector<base::Location> material_places;  // one for each material
  // Ignored properties of each material that would change the picture; may be shorter.
  std::vector<std::vector<std::string>> unsupported_of_material;
  // Colour variants of the file's materials: variant name to original name.
  std::map<std::string, std::string> variant_of;
  std::vector<MaterialLibrary> libraries;
  std::vector<std::filesystem::path> files;  // files that were read or are referenced
  std::vector<MeshLamp> lamps;
  std::vector<MeshCamera> cameras;
  std::vector<std::string> warnings;
  // Contents of the file that are not read, with their counts.
  std::map<std::string, std::size_t> unused;
  // Unread contents that would change the picture. Materials count only if an object uses them.
  std::map<std::string, std::size_t> unsupported;
};

// Appends a polygon; its corners are vertices of the mesh.
template <class Indices>
void add_polygon(Mesh& mesh, const Indices& corners, std::uint32_t part_set, std::uint32_t material,
                 std::uint32_t line = 0) {
  MeshPolygon polygon;
  polygon.first = static_cast<std::uint32_t>(mesh.indices.size());
  mesh.indices.insert(mesh.indices.end(), std::begin(corners), std::end(corners));
  polygon.count = static_cast<std::uint32_t>(mesh.indices.size()) - polygon.first;
  polygon.part_set = part_set;
  polygon.material = material;
  polygon.line = line;
  mesh.polygons.push_back(polygon);
}

// Index of `name` in `names`; appends new names. `known` maps names to indices; the caller owns
// both.
template <class Map>
[[nodiscard]] std::uint32_t number_of(const std::string& name, std::vector<std::string>& names,
                                      Map& known) {
  const auto [entry, fresh] = known.emplace(name, static_cast<std::uint32_t>(names.size()));
  if (fresh) names.push_back(name);
  return entry->second;
}

}  // namespace earthshine::scenes
