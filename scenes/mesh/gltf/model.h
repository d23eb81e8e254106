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

enum class GltfNumber { Uint8, Uint16, Uint32, Float32, Other };

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
  std::optional<GltfSparse> sparse;
};

enum class GltfMode { Triangles, Strip, Fan, Other };

struct GltfPrimitive {
  GltfMode mode = GltfMode::Other;
  int position = -1, indices = -1, material = -1;  // -1: none
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
};

struct GltfNode {
  std::string name;
  int mesh = -1;
  std::vector<int> children;
  std::vector<double> matrix, translation, rotation, scale;  // empty when not given
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
  bool textured = false;
  bool transparent = false;
  std::map<std::string, std::size_t> unused;  // what nothing here reads, as Mesh::unused
};

// Throws base::Error (Input) at the file.
[[noreturn]] void gltf_fail(const std::filesystem::path& path, std::string_view found,
                            std::string_view allowed = {});

// Buffers only from the folders, no images. Materials: metallic-roughness as Phong, the energy
// kept: the metallic share goes to a lobe with n = 2/r^4 - 2, or to the mirror when the roughness r
// is below 0.05.
[[nodiscard]] GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                                        std::span<const std::filesystem::path> folders);

// The accessor's values, checked against buffer view and buffer in wide arithmetic; sparse ones
// included.
[[nodiscard]] std::vector<Vec3> read_gltf_positions(const GltfModel& model, int accessor,
                                                    const std::filesystem::path& path);
[[nodiscard]] std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int accessor,
                                                           const std::filesystem::path& path);

}  // namespace earthshine::scenes
