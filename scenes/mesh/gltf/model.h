// SPDX-License-Identifier: Apache-2.0
// A glTF file as read by tinygltf. The values that are read are validated (json.h), but indices may
// be out of range. Holds its materials, lamps and cameras in the scene's form.
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

// In its own coordinates: at the origin, toward -z.
struct GltfLamp {
  Lamp lamp;
  bool is_lamp = true;  // false: of an unknown type
};

struct GltfCamera {
  Camera camera;
  bool is_camera = true;  // false: orthographic
};

// Sets TEXCOORD_n of a material's textures: of most of them, and of emission if it has another one.
struct CoordinateSets {
  std::optional<int> first, second;
};

struct GltfModel {
  tinygltf::Model file;                      // without its images
  std::vector<Material> materials;           // names may be empty or repeated
  std::vector<std::filesystem::path> files;  // that the file references
  std::vector<CoordinateSets> coordinates;   // of each material
  // For each material, the original of which it is a colour variant; no_index: a material of the
  // file. A variant's own name is its colour only.
  std::vector<std::uint32_t> variant_of;
  // The material of each mesh's primitives; no_index: a material that does not exist.
  std::vector<std::vector<std::uint32_t>> worn;
  std::vector<std::vector<std::string>> unsupported_of_material;  // as in Mesh
  std::vector<GltfLamp> lamps;
  std::vector<GltfCamera> cameras;
  std::vector<std::string> warnings;
  std::map<std::string, std::size_t> unused;       // contents that are not read, as Mesh::unused
  std::map<std::string, std::size_t> unsupported;  // except for materials, as Mesh::unsupported
};

// Throws base::Error (Input) for the file.
[[noreturn]] void gltf_fail(const std::filesystem::path& path, std::string_view found,
                            std::string_view allowed = {});

// Extensions whose values are read.
[[nodiscard]] bool is_read_extension(const std::string& name);

// Reads buffers and pictures from the folders only. Materials: materials.h; lamps and cameras:
// punctual.h.
[[nodiscard]] GltfModel load_gltf_model(std::string_view bytes, const std::filesystem::path& path,
                                        std::span<const std::filesystem::path> folders);

// A node's own transform: its matrix, or translation, rotation and scale in that order. Throws
// base::Error (Input) for a wrong number of values, values that are not finite, and projections.
[[nodiscard]] glm::dmat4 node_matrix(const tinygltf::Node& node, const std::filesystem::path& path);

// The accessor's values, with offsets checked against buffer view and buffer; supports sparse
// accessors. The third component of two-component vectors is 0; quantised values are converted to
// the shares or integers they represent. `attribute` is for messages.
[[nodiscard]] std::vector<Vec3> read_gltf_vectors(const GltfModel& model, int accessor,
                                                  int components, std::string_view attribute,
                                                  const std::filesystem::path& path);

// COLOR_0 of a primitive's vertices, in [0, 1]; empty: none.
[[nodiscard]] std::vector<glm::dvec4> read_gltf_colours(const GltfModel& model,
                                                        const tinygltf::Primitive& primitive,
                                                        const std::filesystem::path& path);

// Allowed form of an attribute.
struct GltfAttribute {
  std::string_view name;    // for messages
  int least = 4, most = 4;  // components
  // Integers are shares of their maximum, even if the file omits "normalized".
  bool is_share = false;
};
// Values with up to four components; a missing fourth one is 1.
[[nodiscard]] std::vector<glm::dvec4> read_gltf_fours(const GltfModel& model, int accessor,
                                                      const GltfAttribute& attribute,
                                                      const std::filesystem::path& path);
[[nodiscard]] std::vector<glm::dmat4> read_gltf_matrices(const GltfModel& model, int accessor,
                                                         const std::filesystem::path& path);
[[nodiscard]] std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int accessor,
                                                           const std::filesystem::path& path);

}  // namespace earthshine::scenes
