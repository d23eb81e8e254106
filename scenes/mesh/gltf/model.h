// SPDX-License-Identifier: Apache-2.0
// A glTF file's geometry as plain values, not checked yet: numbers may point anywhere.
// gltf_model.cpp, which makes it, is the only reader through tinygltf.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/mesh.h"

namespace earthshine::scenes {

struct GltfView {
  int buffer = -1;
  std::size_t offset = 0, length = 0, stride = 0;  // bytes; stride 0: tightly packed
};

enum class GltfNumber { Int8, Uint8, Int16, Uint16, Uint32, Float32, Other };

struct GltfSparse {
  int count = 0;
  GltfNumber index_number = GltfNumber::Other;
  int index_view = -1, value_view = -1;
  std::int64_t index_offset = 0, value_offset = 0;  // bytes
};

struct GltfAccessor {
  int view = -1;
  std::size_t offset = 0, count = 0;
  GltfNumber number = GltfNumber::Other;
  int components = 0;
  bool normalized = false;  // whole numbers stand for shares of their largest
  std::optional<GltfSparse> sparse;
};

enum class GltfMode { Triangles, Strip, Fan, Other };

struct GltfPrimitive {
  GltfMode mode = GltfMode::Other;
  int position = -1, indices = -1, material = -1;  // -1: none
  int normal = -1;
  std::map<int, int> coordinates;  // TEXCOORD_n, by n
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
};

struct GltfNode {
  std::string name;
  int mesh = -1, lamp = -1, camera = -1;
  std::vector<int> children;
  std::vector<double> matrix, translation, rotation, scale;  // empty when not given
};

// As its table has it: at the origin, toward -z.
struct GltfLamp {
  Lamp lamp;
  bool is_lamp = true;  // false: light from everywhere along one direction
};

struct GltfCamera {
  Camera camera;
  bool is_camera = true;  // false: without perspective
};

struct GltfModel {
  std::vector<std::vector<unsigned char>> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<std::vector<int>> scenes;  // root nodes of each
  int default_scene = -1;
  std::vector<Material> materials;           // names may be empty or repeated
  std::vector<std::filesystem::path> files;  // that the file names
  std::vector<int> coordinates;              // of each material: TEXCOORD_n of its textures
  std::vector<GltfLamp> lamps;
  std::vector<GltfCamera> cameras;
  std::vector<std::string> warnings;
  std::map<std::string, std::size_t> unused;  // what nothing here reads, as Mesh::unused
};

// Throws base::Error (Input) at the file.
[[noreturn]] void gltf_fail(const std::filesystem::path& path, std::string_view found,
                            std::string_view allowed = {});

// Buffers and pictures only from the folders. Materials: materials.h; lamps and cameras:
// punctual.h.
[[nodiscard]] GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                                        std::span<const std::filesystem::path> folders);

// A node's own transform: its matrix, or translation, rotation and scale in that order. Throws
// base::Error (Input) for numbers that are too few, too many or not finite.
[[nodiscard]] glm::dmat4 node_matrix(const GltfNode& node, const std::filesystem::path& path);

// The accessor's values, checked against buffer view and buffer in wide arithmetic; sparse ones
// included. Of vectors with two components the third is 0; quantised ones come as the shares or
// whole numbers that they stand for. `attribute` is for messages.
[[nodiscard]] std::vector<Vec3> read_gltf_vectors(const GltfModel& model, int accessor,
                                                  int components, std::string_view attribute,
                                                  const std::filesystem::path& path);
[[nodiscard]] std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int accessor,
                                                           const std::filesystem::path& path);

}  // namespace earthshine::scenes
