// SPDX-License-Identifier: Apache-2.0
// A glTF file as tinygltf reads it, its values checked one by one (json.h) but not against each
// other: numbers may point anywhere. Its materials, lamps and cameras as the scene has them.
#pragma once

#include <tiny_gltf.h>

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

// As its table has it: at the origin, toward -z.
struct GltfLamp {
  Lamp lamp;
  bool is_lamp = true;  // false: of a type that the extension does not have
};

struct GltfCamera {
  Camera camera;
  bool is_camera = true;  // false: without perspective
};

// TEXCOORD_n of a material's textures: of most, and of emission where that has another one.
struct CoordinateSets {
  std::optional<int> first, second;
};

struct GltfModel {
  tinygltf::Model file;                      // without its images
  std::vector<Material> materials;           // names may be empty or repeated
  std::vector<std::filesystem::path> files;  // that the file names
  std::vector<CoordinateSets> coordinates;   // of each material
  // Of each material: the one that it is in another colour; no_index: a material of the file. The
  // name of a variant says its colour alone.
  std::vector<std::uint32_t> variant_of;
  // The material of each mesh's primitives; no_index: one that does not exist.
  std::vector<std::vector<std::uint32_t>> worn;
  std::vector<std::vector<std::string>> lacks;  // of each material, as Mesh::material_lacks
  std::vector<GltfLamp> lamps;
  std::vector<GltfCamera> cameras;
  std::vector<std::string> warnings;
  std::map<std::string, std::size_t> unused;   // what nothing here reads, as Mesh::unused
  std::map<std::string, std::size_t> lacking;  // of it, but for materials', as Mesh::lacking
};

// Throws base::Error (Input) at the file.
[[noreturn]] void gltf_fail(const std::filesystem::path& path, std::string_view found,
                            std::string_view allowed = {});

// Buffers and pictures only from the folders. Materials: materials.h; lamps and cameras:
// punctual.h.
[[nodiscard]] GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                                        std::span<const std::filesystem::path> folders);

// A node's own transform: its matrix, or translation, rotation and scale in that order. Throws
// base::Error (Input) for numbers that are too few, too many or not finite, and for a projection.
[[nodiscard]] glm::dmat4 node_matrix(const tinygltf::Node& node, const std::filesystem::path& path);

// The accessor's values, checked against buffer view and buffer in wide arithmetic; sparse ones
// included. Of vectors with two components the third is 0; quantised ones come as the shares or
// whole numbers that they stand for. `attribute` is for messages.
[[nodiscard]] std::vector<Vec3> read_gltf_vectors(const GltfModel& model, int accessor,
                                                  int components, std::string_view attribute,
                                                  const std::filesystem::path& path);

// COLOR_0 of a primitive's vertices, in [0, 1]; empty: it has none.
[[nodiscard]] std::vector<glm::dvec4> read_gltf_colours(const GltfModel& model,
                                                        const tinygltf::Primitive& primitive,
                                                        const std::filesystem::path& path);

// What an attribute may be, for the readers below.
struct GltfAttribute {
  std::string_view name;    // for messages
  int least = 4, most = 4;  // components
  // Whole numbers stand for shares of the largest, even where the file leaves out "normalized".
  bool is_share = false;
};
// The same of up to four components; a fourth one that is not there is 1.
[[nodiscard]] std::vector<glm::dvec4> read_gltf_fours(const GltfModel& model, int accessor,
                                                      const GltfAttribute& attribute,
                                                      const std::filesystem::path& path);
[[nodiscard]] std::vector<glm::dmat4> read_gltf_matrices(const GltfModel& model, int accessor,
                                                         const std::filesystem::path& path);
[[nodiscard]] std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int accessor,
                                                           const std::filesystem::path& path);

}  // namespace earthshine::scenes
