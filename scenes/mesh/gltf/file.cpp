// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>

#include "scenes/mesh/gltf/model.h"
#include "scenes/mesh/gltf/punctual.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

class GltfReader {
 public:
  GltfReader(const GltfModel& model, const std::filesystem::path& path, VertexNormals normals)
      : model_(model),
        path_(path),
        shaped_by_normals_(normals == VertexNormals::Shape),
        visited_(model.file.nodes.size(), 0) {
    mesh_.path = path;
  }

  Mesh read() {
    name_materials();
    mesh_.unused = model_.unused;
    mesh_.warnings = model_.warnings;
    for (const int root : roots()) visit(root, glm::dmat4(1.0), {}, 1);
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      const tinygltf::Node& node = model_.file.nodes[i];
      const bool holds = node.mesh >= 0 || node.camera >= 0 || lamp_on(node) >= 0;
      if (visited_[i] == 0 && holds) ++mesh_.unused["nodes outside the scene that is read"];
    }
    if (!mesh_.uv.empty()) mesh_.uv_indices.resize(mesh_.indices.size(), no_index);
    if (shaped_by_normals_) mesh_.unused.erase("NORMAL");
    return std::move(mesh_);
  }

 private:
  void name_materials() {
    std::unordered_set<std::string> names;
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      Material material = model_.materials[i];
      if (material.name.empty()) material.name = fmt::format("material {}", i);
      // Materials are told apart by name from here on.
      if (!names.insert(material.name).second) material.name += fmt::format(" ({})", i);
      names.insert(material.name);
      material.light_group = material.name;
      mesh_.material_names.push_back(material.name);
      mesh_.materials.push_back(std::move(material));
      mesh_.material_places.push_back({path_.string()});
    }
  }

  [[nodiscard]] std::vector<int> roots() const {
    if (!model_.file.scenes.empty()) {
      const int chosen = std::max(0, model_.file.defaultScene);
      if (static_cast<std::size_t>(chosen) >= model_.file.scenes.size()) {
        gltf_fail(path_, fmt::format("the default scene {} does not exist", chosen));
      }
      return model_.file.scenes[static_cast<std::size_t>(chosen)].nodes;
    }
    std::vector<char> is_child(model_.file.nodes.size(), 0);
    for (const tinygltf::Node& node : model_.file.nodes) {
      for (const int child : node.children) {
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
          is_child[static_cast<std::size_t>(child)] = 1;
        }
      }
    }
    std::vector<int> result;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (is_child[i] == 0) result.push_back(static_cast<int>(i));
    }
    return result;
  }

  void visit(int number, const glm::dmat4& parent, std::vector<std::uint32_t> parts, int depth) {
    if (number < 0 || static_cast<std::size_t>(number) >= model_.file.nodes.size()) {
      gltf_fail(path_, fmt::format("node {} does not exist", number),
                fmt::format("the file has {}", model_.file.nodes.size()));
    }
    if (depth > max_node_depth) {
      gltf_fail(path_, "the nodes are nested too deeply",
                fmt::format("allowed are {} levels", max_node_depth));
    }
    // A tree by the specification. Anything else may be a cycle, or grow without bounds.
    if (visited_[static_cast<std::size_t>(number)]++ != 0) {
      gltf_fail(path_, fmt::format("node {} is reached twice", number),
                "nodes form a tree: none is its own ancestor or has two parents");
    }
    const tinygltf::Node& node = model_.file.nodes[static_cast<std::size_t>(number)];
    const glm::dmat4 matrix = parent * node_matrix(node, path_);
    if (!node.name.empty()) parts.push_back(number_of(node.name, mesh_.part_names, part_numbers_));
    if (node.mesh >= 0) add_mesh(node.mesh, matrix, parts);
    add_lamp(node, matrix, parts);
    add_camera(node, matrix, parts);
    for (const int child : node.children) visit(child, matrix, parts, depth + 1);
  }

  std::uint32_t add_parts(const std::vector<std::uint32_t>& parts) {
    mesh_.part_sets.push_back(parts);
    return static_cast<std::uint32_t>(mesh_.part_sets.size() - 1);
  }

  // What a node names by its number.
  template <class Thing>
  const Thing& at(const std::vector<Thing>& things, int number, const char* kind) const {
    const auto index = static_cast<std::size_t>(number);
    if (index < things.size()) return things[index];
    gltf_fail(path_, fmt::format("{} {} does not exist", kind, number),
              fmt::format("the file has {}", things.size()));
  }

  void add_lamp(const tinygltf::Node& node, const glm::dmat4& matrix,
                const std::vector<std::uint32_t>& parts) {
    const int number = lamp_on(node);
    if (number < 0) return;
    const GltfLamp& lamp = at(model_.lamps, number, "light");
    if (!lamp.is_lamp) return;
    MeshLamp made{lamp.lamp, add_parts(parts)};
    if (!node.name.empty()) made.lamp.name = node.name;
    made.lamp.position = Vec3(matrix[3]);
    made.lamp.axis = turned(matrix, made.lamp.axis);
    mesh_.lamps.push_back(std::move(made));
  }

  void add_camera(const tinygltf::Node& node, const glm::dmat4& matrix,
                  const std::vector<std::uint32_t>& parts) {
    if (node.camera < 0) return;
    const GltfCamera& camera = at(model_.cameras, node.camera, "camera");
    if (!camera.is_camera) return;
    MeshCamera made{camera.camera, add_parts(parts)};
    if (!node.name.empty()) made.camera.name = node.name;
    made.camera.position = Vec3(matrix[3]);
    made.camera.look_at = made.camera.position + turned(matrix, {0.0, 0.0, -1.0});
    made.camera.up = turned(matrix, {0.0, 1.0, 0.0});
    mesh_.cameras.push_back(std::move(made));
  }

  [[nodiscard]] Vec3 turned(const glm::dmat4& matrix, const Vec3& direction) const {
    const Vec3 made = glm::dmat3(matrix) * direction;
    if (!(glm::length(made) > 0.0)) {
      gltf_fail(path_, "a lamp or a camera hangs on a node of scale 0");
    }
    return glm::normalize(made);
  }

  void add_mesh(int number, const glm::dmat4& matrix, std::vector<std::uint32_t> parts) {
    if (static_cast<std::size_t>(number) >= model_.file.meshes.size()) {
      gltf_fail(path_, fmt::format("mesh {} does not exist", number),
                fmt::format("the file has {}", model_.file.meshes.size()));
    }
    const tinygltf::Mesh& mesh = model_.file.meshes[static_cast<std::size_t>(number)];
    if (!mesh.name.empty()) parts.push_back(number_of(mesh.name, mesh_.part_names, part_numbers_));
    part_set_ = add_parts(parts);
    for (const tinygltf::Primitive& primitive : mesh.primitives) add_primitive(primitive, matrix);
  }

  void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& matrix) {
    const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    const bool has_faces = mode == TINYGLTF_MODE_TRIANGLES ||
                           mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                           mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const auto position = primitive.attributes.find("POSITION");
    if (!has_faces || position == primitive.attributes.end()) {
      ++mesh_.unused[has_faces ? "primitives without positions" : "points or lines"];
      return;
    }
    std::uint32_t material = no_index;
    if (primitive.material >= 0) {
      material = static_cast<std::uint32_t>(primitive.material);
      if (material >= model_.materials.size()) {
        gltf_fail(path_, fmt::format("material {} does not exist", material),
                  fmt::format("the file has {}", model_.materials.size()));
      }
    }
    const std::vector<Vec3> positions =
        read_gltf_vectors(model_, position->second, 3, "POSITION", path_);
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) {
      indices = read_gltf_indices(model_, primitive.indices, path_);
    } else {
      for (std::uint32_t i = 0; i < positions.size(); ++i) indices.push_back(i);
    }
    for (const std::uint32_t index : indices) {
      if (index >= positions.size()) {
        gltf_fail(path_, fmt::format("vertex index {} is out of range", index),
                  fmt::format("the primitive has {} vertices", positions.size()));
      }
    }
    const std::size_t total = std::max(mesh_.vertices.size() + positions.size(),
                                       mesh_.indices.size() + 3 * indices.size());
    if (total > 3 * max_gltf_triangles) {
      gltf_fail(
          path_, "the meshes of all nodes together are too large",
          fmt::format("at most {} triangles are read from one glTF file", max_gltf_triangles));
    }
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Vec3& p : positions) mesh_.vertices.emplace_back(matrix * glm::dvec4(p, 1.0));
    const First starts{first, add_coordinates(primitive, material, positions.size()),
                       add_normals(primitive, matrix, positions.size())};
    const bool mirrored = glm::determinant(glm::dmat3(matrix)) < 0.0;
    add_triangles(mode, indices, starts, material, mirrored);
  }

  // Where a primitive's begin in the mesh's lists; no_index: it has none.
  struct First {
    std::uint32_t vertex, uv, normal;
  };

  // Faulty ones are an error where the shape depends on them.
  std::uint32_t add_normals(const tinygltf::Primitive& primitive, const glm::dmat4& matrix,
                            std::size_t count) {
    try {
      return read_normals(primitive, matrix, count);
    } catch (const base::Error&) {
      if (shaped_by_normals_) throw;
      return no_index;
    }
  }

  std::uint32_t read_normals(const tinygltf::Primitive& primitive, const glm::dmat4& matrix,
                             std::size_t count) {
    const auto normal = primitive.attributes.find("NORMAL");
    const bool has_normals = normal != primitive.attributes.end() && normal->second >= 0;
    if (!has_normals) return no_index;
    const auto normals = read_gltf_vectors(model_, normal->second, 3, "NORMAL", path_);
    if (normals.size() < count) gltf_fail(path_, "fewer normals than vertices");
    const auto first = static_cast<std::uint32_t>(mesh_.normals.size());
    const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(matrix)));
    for (const Vec3& n : normals) mesh_.normals.emplace_back(glm::normalize(turn * n));
    return first;
  }

  // Of a primitive with a texture, where they begin in the mesh's; no_index: it has none.
  std::uint32_t add_coordinates(const tinygltf::Primitive& primitive, std::uint32_t material,
                                std::size_t count) {
    if (material == no_index || !model_.materials[material].maps) return no_index;
    const int number = model_.coordinates[material];
    const auto set = primitive.attributes.find(fmt::format("TEXCOORD_{}", number));
    if (number > 9 || set == primitive.attributes.end()) return no_index;
    const std::vector<Vec3> uv = read_gltf_vectors(model_, set->second, 2, "TEXCOORD", path_);
    if (uv.size() < count) {
      gltf_fail(path_, fmt::format("{} texture coordinates", uv.size()),
                fmt::format("the primitive has {} vertices", count));
    }
    const auto first = static_cast<std::uint32_t>(mesh_.uv.size());
    for (const Vec3& place : uv) mesh_.uv.emplace_back(place.x, place.y);
    return first;
  }

  void add_triangles(int mode, const std::vector<std::uint32_t>& indices, First first,
                     std::uint32_t material, bool mirrored) {
    const auto begin = [&](std::uint32_t start, std::vector<std::uint32_t>& list) {
      if (start != no_index) list.resize(mesh_.indices.size(), no_index);
    };
    begin(first.uv, mesh_.uv_indices);
    begin(first.normal, mesh_.normal_indices);
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    if (indices.size() % step != 0) ++mesh_.unused["primitives with corners of no triangle"];
    for (std::size_t i = 0; i + 3 <= indices.size(); i += step) {
      std::array<std::uint32_t, 3> corners{indices[i], indices[i + 1], indices[i + 2]};
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        corners = {indices[0], indices[i + 1], indices[i + 2]};
      // Every second triangle of a strip runs the other way round, and so does a mirrored mesh.
      const bool odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
      if (odd != mirrored) std::swap(corners[1], corners[2]);
      for (std::uint32_t& corner : corners) {
        if (first.uv != no_index) mesh_.uv_indices.push_back(first.uv + corner);
        if (first.normal != no_index) mesh_.normal_indices.push_back(first.normal + corner);
        corner += first.vertex;
      }
      add_polygon(mesh_, corners, part_set_, material);
    }
  }

  const GltfModel& model_;
  const std::filesystem::path& path_;
  bool shaped_by_normals_;
  Mesh mesh_;
  std::vector<int> visited_;
  std::uint32_t part_set_ = 0;
  std::unordered_map<std::string, std::uint32_t> part_numbers_;
};

}  // namespace

Mesh parse_gltf(std::string_view bytes, const std::filesystem::path& path,
                std::span<const std::filesystem::path> folders, VertexNormals normals) {
  GltfModel model = load_gltf_model(bytes, path, folders);
  Mesh mesh = GltfReader(model, path, normals).read();
  mesh.files = std::move(model.files);
  return mesh;
}

}  // namespace earthshine::scenes
