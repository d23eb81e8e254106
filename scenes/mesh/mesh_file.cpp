// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/free_memory.h"
#include "base/input/input_file.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/obj_file.h"
#include "scenes/mesh/ply_file.h"
#include "scenes/mesh/stl_file.h"
#include "scenes/text/confined_path.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

// Final check of all readers' results; the rest of the program relies on it.
void check_mesh(const Mesh& mesh) {
  const base::Location where{mesh.path.string()};
  if (mesh.polygons.empty()) {
    std::string holds;
    for (const auto& [what, count] : mesh.unused) {
      holds += fmt::format("{}{} {}", holds.empty() ? "; it holds " : ", ", count, what);
    }
    throw Error(Blame::Input, where, "the mesh has no faces",
                "a mesh holds triangles or polygons" + holds);
  }
  for (const std::uint32_t index : mesh.indices) {
    if (index >= mesh.vertices.size()) {
      throw Error(Blame::Input, where, fmt::format("vertex index {} is out of range", index),
                  fmt::format("the mesh has {} vertices", mesh.vertices.size()));
    }
  }
  for (const Vec3& v : mesh.vertices) {
    for (int c = 0; c < 3; ++c) {
      if (std::abs(v[c]) <= largest_coordinate) continue;
      throw Error(Blame::Input, where, fmt::format("a vertex at ({}, {}, {})", v.x, v.y, v.z),
                  fmt::format("coordinates are finite and at most {}", largest_coordinate));
    }
  }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, const std::filesystem::path& scene_folder,
               const base::Location& asked_at, VertexNormals normals) {
  const std::string ending = lower_case(path.extension().string());
  constexpr std::string_view known[] = {".obj", ".gltf", ".glb", ".ply", ".stl"};
  if (std::find(std::begin(known), std::end(known), ending) == std::end(known)) {
    throw Error(Blame::Input, asked_at,
                fmt::format("the mesh {} is of an unknown kind", in_quotes(path.string())),
                "known are .obj, .gltf, .glb, .ply and .stl", "Convert it to one of these");
  }
  const std::string bytes = base::read_input_file(path, max_mesh_bytes, asked_at);
  base::check_room(bytes.size(), path.string());  // numbers need about as much memory as their text
  const std::filesystem::path folders[] = {scene_folder, path.parent_path()};
  Mesh mesh;
  if (ending == ".obj") {
    mesh = parse_obj(bytes, path, folders, normals);
    list_map_files(mesh, folders);
  } else if (ending == ".ply") {
    mesh = parse_ply(bytes, path, normals);
  } else if (ending == ".stl") {
    mesh = parse_stl(bytes, path);
  } else {
    mesh = parse_gltf(bytes, path, folders, normals);
  }
  mesh.files.push_back(path);
  check_mesh(mesh);
  return mesh;
}

std::uint32_t find_part(const Mesh& mesh, const std::string& part, const base::Location& asked_at) {
  const auto found = std::find(mesh.part_names.begin(), mesh.part_names.end(), part);
  if (found != mesh.part_names.end()) {
    return static_cast<std::uint32_t>(found - mesh.part_names.begin());
  }
  throw Error(
      Blame::Input, asked_at,
      fmt::format("{} has no part {}", in_quotes(mesh.path.string()), in_quotes(part)),
      mesh.part_names.empty() ? "it has no named parts" : "its parts: " + listed(mesh.part_names),
      did_you_mean(part, mesh.part_names));
}

std::uint32_t find_mesh_material(Mesh& mesh, const std::string& name,
                                 const std::filesystem::path& scene_folder) {
  if (!mesh.libraries.empty()) {
    const std::filesystem::path folders[] = {scene_folder, mesh.path.parent_path()};
    read_material_libraries(mesh, folders);
  }
  const auto found = std::find_if(mesh.materials.begin(), mesh.materials.end(),
                                  [&](const Material& material) { return material.name == name; });
  return found == mesh.materials.end() ? no_index
                                       : static_cast<std::uint32_t>(found - mesh.materials.begin());
}

}  // namespace earthshine::scenes
