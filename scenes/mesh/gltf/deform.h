// SPDX-License-Identifier: Apache-2.0
// Vertex positions of a glTF mesh without animation: morph targets at their default weights, skins
// in their pose, instances of EXT_mesh_gpu_instancing. Only files that own tinygltf include this.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {

// Adds the primitive's weighted morph-target deltas to an attribute (glTF 2.0, 3.7.2.2). Weights
// come from the node, else from the mesh. Throws base::Error (Input) for targets with fewer
// vertices.
void add_morph_targets(const GltfModel& model, const tinygltf::Primitive& primitive,
                       const std::vector<double>& weights, const std::string& attribute,
                       std::vector<Vec3>& values, const std::filesystem::path& path);

// Transforms from file to scene coordinates: one matrix per vertex for a skinned primitive, else
// one for all vertices.
class VertexPoses {
 public:
  explicit VertexPoses(const glm::dmat4& all) : each_{all} {}
  explicit VertexPoses(std::vector<glm::dmat4> each) : each_(std::move(each)) {}
  [[nodiscard]] const glm::dmat4& operator[](std::size_t vertex) const {
    return each_.size() == 1 ? each_.front() : each_[vertex];
  }
  // Whether the transform swaps fronts and backs.
  [[nodiscard]] bool mirrors(std::size_t vertex) const {
    return glm::determinant(glm::dmat3((*this)[vertex])) < 0.0;
  }

 private:
  std::vector<glm::dmat4> each_;
};

// Poses by joints and weights (glTF 2.0, 3.7.3), independent of the transform of the skinned node.
// Weights are normalised; a vertex without weights follows its first joint. Throws base::Error
// (Input) for missing skins, joints or nodes.
[[nodiscard]] VertexPoses skin_poses(const GltfModel& model, int skin,
                                     const tinygltf::Primitive& primitive, std::size_t count,
                                     const std::filesystem::path& path);

// The node's transform times each instance transform; without the extension the node's transform.
[[nodiscard]] std::vector<glm::dmat4> instance_poses(const GltfModel& model,
                                                     const tinygltf::Node& node,
                                                     const glm::dmat4& matrix,
                                                     const std::filesystem::path& path);

}  // namespace earthshine::scenes
