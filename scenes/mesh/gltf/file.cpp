// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>

#include "scenes/mesh/gltf/deform.h"
#include "scenes/mesh/gltf/model.h"
#include "scenes/mesh/gltf/punctual.h"
#include "scenes/mesh/gltf/writer.h"
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
    mesh_.metres = 1.0;  // glTF 2.0, 3.4
    mesh_.is_y_up = true;
    mesh_.is_own = model.file.asset.generator == own_generator;
  }

  Mesh read() {
    name_materials();
    mesh_.unused = model_.unused;
    mesh_.unsupported = model_.unsupported;
    mesh_.unsupported_of_material = model_.unsupported_of_material;
    mesh_.warnings = model_.warnings;
    for (const int root : roots()) visit(root, glm::dmat4(1.0), {}, 1);
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      const tinygltf::Node& node = model_.file.nodes[i];
      const bool holds = node.mesh >= 0 || node.camera >= 0 || lamp_on(node) >= 0;
      if (visited_[i] == 0 && holds) ++mesh_.unused["nodes outside the scene that is read"];
    }
    if (!mesh_.uv.empty()) mesh_.uv_indices.resize(mesh_.indices.size(), no_index);
    if (!mesh_.second_uv.empty()) mesh_.second_uv.resize(mesh_.uv.size(), glm::vec2(0.0F));
    if (!mesh_.colours.empty()) mesh_.colours.resize(mesh_.uv.size(), glm::vec3(1.0F));
    name_missing_coordinates();
    if (shaped_by_normals_) mesh_.unused.erase("NORMAL");
    return std::move(mesh_);
  }

 private:
  void name_materials() {
    std::unordered_set<std::string> names;
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      Material material = model_.materials[i];
      const std::uint32_t base = model_.variant_of[i];
      if (base != no_index) {
        material.name = fmt::format("{} ({})", mesh_.material_names[base], material.name);
      }
      if (material.name.empty()) material.name = fmt::format("material {}", i);
      // Later code identifies materials by name.
      if (!names.insert(material.name).second) material.name += fmt::format(" ({})", i);
      names.insert(material.name);
      material.light_group = base == no_index ? material.name : mesh_.material_names[base];
      if (base != no_index) mesh_.variant_of[material.name] = mesh_.material_names[base];
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
    // Nodes form a tree by the specification. Otherwise they may form cycles or grow without
    // bounds.
    if (visited_[static_cast<std::size_t>(number)]++ != 0) {
      gltf_fail(path_, fmt::format("node {} is reached twice", number),
                "nodes form a tree: none is its own ancestor or has two parents");
    }
    const tinygltf::Node& node = model_.file.nodes[static_cast<std::size_t>(number)];
    const glm::dmat4 matrix = parent * node_matrix(node, path_);
    if (!node.name.empty()) parts.push_back(number_of(node.name, mesh_.part_names, part_numbers_));
    if (node.mesh >= 0) add_mesh(node, matrix, parts);
    add_lamp(node, matrix, parts);
    add_camera(node, matrix, parts);
    for (const int child : node.children) visit(child, matrix, parts, depth + 1);
  }

  std::uint32_t add_parts(const std::vector<std::uint32_t>& parts) {
    mesh_.part_sets.push_back(parts);
    return static_cast<std::uint32_t>(mesh_.part_sets.size() - 1);
  }

  // Object that a node references by index.
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
    if (!made.lamp.is_distant()) made.lamp.position = Vec3(matrix[3]);
    made.lamp.axis = rotated(matrix, made.lamp.axis);
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
    made.camera.look_at = made.camera.position + rotated(matrix, {0.0, 0.0, -1.0});
    made.camera.up = rotated(matrix, {0.0, 1.0, 0.0});
    mesh_.cameras.push_back(std::move(made));
  }

  [[nodiscard]] Vec3 rotated(const glm::dmat4& matrix, const Vec3& direction) const {
    const Vec3 made = glm::dmat3(matrix) * direction;
    if (!(glm::length(made) > 0.0)) {
      gltf_fail(path_, "a lamp or a camera hangs on a node of scale 0");
    }
    return glm::normalize(made);
  }

  void add_mesh(const tinygltf::Node& node, const glm::dmat4& matrix,
                std::vector<std::uint32_t> parts) {
    const tinygltf::Mesh& mesh = at(model_.file.meshes, node.mesh, "mesh");
    if (!mesh.name.empty()) parts.push_back(number_of(mesh.name, mesh_.part_names, part_numbers_));
    part_set_ = add_parts(parts);
    const auto number = static_cast<std::size_t>(node.mesh);
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
      add_primitive(mesh.primitives[k], model_.worn[number][k],
                    {node, node.weights.empty() ? mesh.weights : node.weights, matrix});
    }
  }

  // A mesh at a node.
  struct Hung {
    const tinygltf::Node& node;
    const std::vector<double>& weights;  // of its morph targets
    const glm::dmat4& matrix;            // of the node
  };

  void add_primitive(const tinygltf::Primitive& primitive, std::uint32_t material,
                     const Hung& hung) {
    const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    const bool has_faces = mode == TINYGLTF_MODE_TRIANGLES ||
                           mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                           mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const auto position = primitive.attributes.find("POSITION");
    if (!has_faces || position == primitive.attributes.end()) {
      ++mesh_.unused[has_faces ? "primitives without positions" : "points or lines"];
      return;
    }
    if (material == no_index) {
      gltf_fail(path_, fmt::format("material {} does not exist", primitive.material));
    }
    std::vector<Vec3> positions = read_gltf_vectors(model_, position->second, 3, "POSITION", path_);
    add_morph_targets(model_, primitive, hung.weights, "POSITION", positions, path_);
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
    if (hung.node.skin >= 0) {
      add_vertices(primitive, material, hung, mode, positions, indices,
                   skin_poses(model_, hung.node.skin, primitive, positions.size(), path_));
      return;
    }
    for (const glm::dmat4& pose : instance_poses(model_, hung.node, hung.matrix, path_)) {
      add_vertices(primitive, material, hung, mode, positions, indices, VertexPoses(pose));
    }
  }

  void add_vertices(const tinygltf::Primitive& primitive, std::uint32_t material, const Hung& hung,
                    int mode, const std::vector<Vec3>& positions,
                    const std::vector<std::uint32_t>& indices, const VertexPoses& poses) {
    const std::size_t total = std::max(mesh_.vertices.size() + positions.size(),
                                       mesh_.indices.size() + 3 * indices.size());
    if (total > 3 * max_gltf_triangles) {
      gltf_fail(
          path_, "the meshes of all nodes together are too large",
          fmt::format("at most {} triangles are read from one glTF file", max_gltf_triangles));
    }
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      mesh_.vertices.emplace_back(poses[i] * glm::dvec4(positions[i], 1.0));
    }
    const First starts{first, add_coordinates(primitive, material, positions.size()),
                       add_normals(primitive, hung, poses, positions.size())};
    add_triangles(mode, indices, starts, material, poses);
  }

  // Start of a primitive's entries in the mesh's lists; no_index: none.
  struct First {
    std::uint32_t vertex, uv, normal;
  };

  // Faulty normals are an error if the shape depends on them.
  std::uint32_t add_normals(const tinygltf::Primitive& primitive, const Hung& hung,
                            const VertexPoses& poses, std::size_t count) {
    try {
      return read_normals(primitive, hung, poses, count);
    } catch (const base::Error&) {
      if (shaped_by_normals_) throw;
      return no_index;
    }
  }

  std::uint32_t read_normals(const tinygltf::Primitive& primitive, const Hung& hung,
                             const VertexPoses& poses, std::size_t count) {
    const auto normal = primitive.attributes.find("NORMAL");
    const bool has_normals = normal != primitive.attributes.end() && normal->second >= 0;
    if (!has_normals) return no_index;
    auto normals = read_gltf_vectors(model_, normal->second, 3, "NORMAL", path_);
    if (normals.size() < count) gltf_fail(path_, "fewer normals than vertices");
    add_morph_targets(model_, primitive, hung.weights, "NORMAL", normals, path_);
    const auto first = static_cast<std::uint32_t>(mesh_.normals.size());
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dmat3 to_normals = glm::transpose(glm::inverse(glm::dmat3(poses[i])));
      mesh_.normals.emplace_back(glm::normalize(to_normals * normals[i]));
    }
    return first;
  }

  // TEXCOORD_n of a primitive; empty: none.
  std::vector<Vec3> coordinates(const tinygltf::Primitive& primitive, int number,
                                std::size_t count) {
    const auto set = primitive.attributes.find(fmt::format("TEXCOORD_{}", number));
    if (set == primitive.attributes.end() || set->second < 0) {
      ++without_coordinates_;
      return {};
    }
    std::vector<Vec3> uv = read_gltf_vectors(model_, set->second, 2, "TEXCOORD", path_);
    if (uv.size() < count) {
      gltf_fail(path_, fmt::format("{} texture coordinates", uv.size()),
                fmt::format("the primitive has {} vertices", count));
    }
    uv.resize(count);
    return uv;
  }

  // Start of a primitive's texture coordinates and colours in the mesh's lists; no_index: its
  // material does not vary.
  std::uint32_t add_coordinates(const tinygltf::Primitive& primitive, std::uint32_t material,
                                std::size_t count) {
    const auto& maps = model_.materials[material].maps;
    if (!maps) return no_index;
    const auto first = static_cast<std::uint32_t>(mesh_.uv.size());
    const auto append = [&](auto& list, const auto& values, const auto& otherwise) {
      list.resize(first, otherwise);
      for (const auto& v : values) list.emplace_back(v);
      list.resize(first + count, otherwise);
    };
    const CoordinateSets& sets = model_.coordinates[material];
    const glm::vec2 corner(0.0F);
    append(mesh_.uv, sets.first ? coordinates(primitive, *sets.first, count) : std::vector<Vec3>(),
           corner);
    if (sets.second) {
      append(mesh_.second_uv, coordinates(primitive, *sets.second, count), corner);
    }
    if (maps->by_vertex) {
      std::vector<glm::dvec4> colours = read_gltf_colours(model_, primitive, path_);
      colours.resize(count, glm::dvec4(1.0));
      append(mesh_.colours, colours, glm::vec3(1.0F));
    }
    return first;
  }

  void name_missing_coordinates() {
    if (without_coordinates_ == 0) return;
    mesh_.warnings.push_back(
        fmt::format("{}: {} primitives lack the texture coordinates of their material; they take "
                    "the texture's upper left corner",
                    path_.string(), without_coordinates_));
  }

  void add_triangles(int mode, const std::vector<std::uint32_t>& indices, First first,
                     std::uint32_t material, const VertexPoses& poses) {
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
      // Every second triangle of a strip has the opposite winding, and so has a mirrored mesh.
      const bool odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
      if (odd != poses.mirrors(corners[0])) std::swap(corners[1], corners[2]);
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
  std::size_t without_coordinates_ = 0;  // coordinate sets that primitives lack
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
