// SPDX-License-Identifier: Apache-2.0
// A mesh as its file (or a shape) has it: polygons in the file's own coordinates, before any
// transform.
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
// Larger coordinates are slips; their squares would still be exact enough, their scene would not.
inline constexpr double largest_coordinate = 1e15;

struct MeshPolygon {
  std::uint32_t first = 0;  // into Mesh::indices
  std::uint32_t count = 0;
  std::uint32_t part_set = 0;         // into Mesh::part_sets
  std::uint32_t material = no_index;  // into Mesh::material_names
  std::uint32_t line = 0;             // of the file; 0: not known
};

// A material library that an OBJ file names. It is read when a material is looked for in vain in
// the scene.
struct MaterialLibrary {
  std::string named;
  base::Location where;
};

// What Mesh::unused calls lamps and cameras, which objects take over when they ask for them.
inline constexpr const char* lamps_of_file = "lights";
inline constexpr const char* cameras_of_file = "cameras";
// Beside these, what nobody can take over.
inline constexpr const char* unknown_lamps_of_file = "lights of an unknown type";
inline constexpr const char* flat_cameras_of_file = "orthographic cameras";

// A lamp or a camera among the faces, in the file's own coordinates; names may be empty or
// repeated.
struct MeshLamp {
  Lamp lamp;
  std::uint32_t part_set = 0;
};
struct MeshCamera {
  Camera camera;
  std::uint32_t part_set = 0;
};

// What the normals of vertices are for: to tell fronts from backs, where a faulty one is none, or
// to round the surface by, where it is an error.
enum class VertexNormals { Sides, Shape };

// How OBJ, PLY and glTF files call them, in Mesh::unused.
inline constexpr std::string_view normals_of_file[] = {"vn", "nx", "ny", "nz", "NORMAL"};

struct Mesh {
  std::filesystem::path path;    // empty for a shape
  std::optional<double> metres;  // of its unit of length; nothing: the scene's unit
  bool is_y_up = false;          // by its format; false: the format does not say
  bool is_own = false;           // this program wrote it, and turned z up to y up
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;     // counter-clockwise seen from the front
  std::vector<glm::vec2> uv;              // texture coordinates, v down from the upper edge
  std::vector<std::uint32_t> uv_indices;  // into uv, one for each of `indices`; no_index: none.
                                          // Empty: no corner has any
  // Beside uv, and as long, or empty: a second set, and what multiplies the diffuse colour.
  std::vector<glm::vec2> second_uv;
  std::vector<glm::vec3> colours;
  std::vector<glm::vec3> normals;             // of the surface; 0 where the file's is faulty
  std::vector<std::uint32_t> normal_indices;  // as uv_indices
  std::vector<MeshPolygon> polygons;
  std::vector<std::string> part_names;                // groups, objects, nodes, meshes, solids
  std::vector<std::vector<std::uint32_t>> part_sets;  // a polygon may belong to several
  std::vector<std::string> material_names;
  std::vector<Material> materials;              // those that the file itself or a library defines
  std::vector<base::Location> material_places;  // of each of these
  std::vector<std::vector<std::string>> material_lacks;  // what of each is not used, though the
      // picture would change by it; may be shorter
  // Materials that the file has in another colour under the name on the right.
  std::map<std::string, std::string> variant_of;
  std::vector<MaterialLibrary> libraries;
  std::vector<std::filesystem::path> files;  // that it was read from, or that it names
  std::vector<MeshLamp> lamps;
  std::vector<MeshCamera> cameras;
  std::vector<std::string> warnings;
  // What the file holds besides that nothing here reads, and how often.
  std::map<std::string, std::size_t> unused;
  // What of it would change the picture: of materials only what some object wears.
  std::map<std::string, std::size_t> lacking;
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

// Names to running numbers: the number of `name` in `names`, appended if it is new.
// `known` is an index of names; both belong to the caller.
template <class Map>
[[nodiscard]] std::uint32_t number_of(const std::string& name, std::vector<std::string>& names,
                                      Map& known) {
  const auto [entry, fresh] = known.emplace(name, static_cast<std::uint32_t>(names.size()));
  if (fresh) names.push_back(name);
  return entry->second;
}

}  // namespace earthshine::scenes
