// SPDX-License-Identifier: Apache-2.0
// Where the vertices of a glTF mesh are without animation: morph targets at their default weights,
// skins in their pose, instances of EXT_mesh_gpu_instancing. Only the files that own tinygltf
// include this.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {

// Adds the deltas of the primitive's morph targets to an attribute's values, each times its weight
// (glTF 2.0, 3.7.2.2): those of the node, else of the mesh. Throws base::Error (Input) for targets
// with fewer vertices.
void add_morph_targets(const GltfModel& model, const tinygltf::Primitive& primitive,
                       const std::vector<double>& weights, const std::string& attribute,
                       std::vector<Vec3>& values, const std::filesystem::path& path);

// From a vertex's place in the file to its place in the scene that is read; of a skinned primitive
// a matrix for each vertex, else one for all.
class VertexPoses {
 public:
  explicit VertexPoses(const glm::dmat4& all) : each_{all} {}
  explicit VertexPoses(std::vector<glm::dmat4> each) : each_(std::move(each)) {}
  [[nodiscard]] const glm::dmat4& operator[](std::size_t vertex) const {
    return each_.size() == 1 ? each_.front() : each_[vertex];
  }
  // Fronts become backs there.
  [[nodiscard]] bool mirrors(std::size_t vertex) const {
    return glm::determinant(glm::dmat3((*this)[vertex])) < 0.0;
  }

 private:
  std::vector<glm::dmat4> each_;
};

// By joints and weights (glTF 2.0, 3.7.3): the transform of the node that wears the skin does not
// count. Weights are divided by their sum; a vertex without any follows its first joint. Throws
// base::Error (Input) for skins, joints or nodes that do not exist.
[[nodiscard]] VertexPoses skin_poses(const GltfModel& model, int skin,
                                     const tinygltf::Primitive& primitive, std::size_t count,
                                     const std::filesystem::path& path);

// The node's own transform times each of its instances; without the extension that transform alone.
[[nodiscard]] std::vector<glm::dmat4> instance_poses(const GltfModel& model,
                                                     const tinygltf::Node& node,
                                                     const glm::dmat4& matrix,
                                                     const std::filesystem::path& path);

}  // namespace earthshine::scenes
