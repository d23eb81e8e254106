// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/deform.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "base/free_memory.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/textures.h"

namespace earthshine::scenes {
namespace {

constexpr const char* instancing = "EXT_mesh_gpu_instancing";

std::optional<int> attribute_of(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end() || found->second < 0) return std::nullopt;
  return found->second;
}

// The matrices of a skin's joints: from the rest pose to the joint's pose.
class Joints {
 public:
  Joints(const GltfModel& model, int number, const std::filesystem::path& path)
      : model_(model), path_(path), parent_(model.file.nodes.size(), -1) {
    const auto& skins = model.file.skins;
    if (static_cast<std::size_t>(number) >= skins.size()) {
      gltf_fail(path, fmt::format("skin {} does not exist", number),
                fmt::format("the file has {}", skins.size()));
    }
    const tinygltf::Skin& skin = skins[static_cast<std::size_t>(number)];
    for (std::size_t n = 0; n < parent_.size(); ++n) {
      for (const int child : model.file.nodes[n].children) {
        if (child >= 0 && static_cast<std::size_t>(child) < parent_.size()) {
          parent_[static_cast<std::size_t>(child)] = static_cast<int>(n);
        }
      }
    }
    std::vector<glm::dmat4> inverse(skin.joints.size(), glm::dmat4(1.0));
    if (skin.inverseBindMatrices >= 0) {
      inverse = read_gltf_matrices(model, skin.inverseBindMatrices, path);
      if (inverse.size() < skin.joints.size()) {
        gltf_fail(path, fmt::format("skin {} has fewer inverse bind matrices than joints", number));
      }
    }
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      matrices_.push_back(in_scene(skin.joints[j]) * inverse[j]);
    }
  }

  [[nodiscard]] const glm::dmat4& operator[](double joint) const {
    if (joint >= 0.0 && joint < static_cast<double>(matrices_.size())) {
      return matrices_[static_cast<std::size_t>(joint)];
    }
    gltf_fail(path_, fmt::format("a vertex follows joint {}", joint),
              fmt::format("its skin has {}", matrices_.size()));
  }

 private:
  [[nodiscard]] glm::dmat4 in_scene(int number) const {
    glm::dmat4 matrix(1.0);
    for (int depth = 0; number >= 0; ++depth) {
      const auto node = static_cast<std::size_t>(number);
      if (node >= parent_.size() || depth > max_node_depth) {
        gltf_fail(path_, fmt::format("a skin has the joint {}", number),
                  fmt::format("joints are nodes of the file, which has {}, at most {} deep",
                              parent_.size(), max_node_depth));
      }
      matrix = node_matrix(model_.file.nodes[node], path_) * matrix;
      number = parent_[node];
    }
    return matrix;
  }

  const GltfModel& model_;
  const std::filesystem::path& path_;
  std::vector<int> parent_;  // per node; -1: none
  std::vector<glm::dmat4> matrices_;
};

}  // namespace

void add_morph_targets(const GltfModel& model, const tinygltf::Primitive& primitive,
                       const std::vector<double>& weights, const std::string& attribute,
                       std::vector<Vec3>& values, const std::filesystem::path& path) {
  for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
    const auto target = primitive.targets[t].find(attribute);
    if (weights[t] == 0.0 || target == primitive.targets[t].end()) continue;
    const std::vector<Vec3> deltas =
        read_gltf_vectors(model, target->second, 3, attribute + " of a morph target", path);
    if (deltas.size() < values.size()) {
      gltf_fail(path, fmt::format("a morph target of {} vertices", deltas.size()),
                fmt::format("its primitive has {}", values.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weights[t] * deltas[i];
  }
}

VertexPoses skin_poses(const GltfModel& model, int skin, const tinygltf::Primitive& primitive,
                       std::size_t count, const std::filesystem::path& path) {
  const Joints joints(model, skin, path);
  base::check_room(count * (sizeof(glm::dmat4) + 3 * sizeof(glm::dvec4)), path.string());
  std::vector<glm::dmat4> sum(count, glm::dmat4(0.0));
  std::vector<double> weight(count, 0.0), first(count, 0.0);
  for (int set = 0;; ++set) {
    const auto named = attribute_of(primitive, fmt::format("JOINTS_{}", set));
    const auto weighed = attribute_of(primitive, fmt::format("WEIGHTS_{}", set));
    if (!named || !weighed) {
      if (set == 0) {
        gltf_fail(path, "a skinned primitive has no joints or no weights",
                  "it has the attributes JOINTS_0 and WEIGHTS_0");
      }
      break;
    }
    const auto numbers = read_gltf_fours(model, *named, {"JOINTS"}, path);
    const auto shares = read_gltf_fours(model, *weighed, {"WEIGHTS", 4, 4, true}, path);
    if (std::min(numbers.size(), shares.size()) < count) {
      gltf_fail(path, fmt::format("joints or weights of fewer than its {} vertices", count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (set == 0) first[i] = numbers[i][0];
      for (int c = 0; c < 4; ++c) {
        if (!(shares[i][c] > 0.0)) continue;
        sum[i] += shares[i][c] * joints[numbers[i][c]];
        weight[i] += shares[i][c];
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    sum[i] = weight[i] > 0.0 ? sum[i] / weight[i] : joints[first[i]];
  }
  return VertexPoses(std::move(sum));
}

std::vector<glm::dmat4> instance_poses(const GltfModel& model, const tinygltf::Node& node,
                                       const glm::dmat4& matrix,
                                       const std::filesystem::path& path) {
  const tinygltf::Value table = extension_of(node.extensions, instancing);
  if (!table.IsObject() || !table.Has("attributes")) return {matrix};
  const tinygltf::Value& attributes = table.Get("attributes");
  if (!attributes.IsObject()) return {matrix};
  const auto read = [&](const char* name, int components) {
    const auto number = static_cast<int>(number_of(attributes, name, -1.0));
    if (number < 0) return std::vector<glm::dvec4>();
    return read_gltf_fours(model, number, {name, components, components}, path);
  };
  const auto shifts = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
             scales = read("SCALE", 3);
  if (!attributes.Has("TRANSLATION") && !attributes.Has("ROTATION") && !attributes.Has("SCALE")) {
    return {matrix};
  }
  const std::size_t count = std::max({shifts.size(), rotations.size(), scales.size()});
  for (const auto* list : {&shifts, &rotations, &scales}) {
    if (list->empty() || list->size() == count) continue;
    gltf_fail(path, fmt::format("{} with {} and {} values", instancing, list->size(), count),
              "its attributes have one value for each instance");
  }
  base::check_room(count * sizeof(glm::dmat4), path.string());
  std::vector<glm::dmat4> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    glm::dmat4 pose = matrix;
    if (!shifts.empty()) pose = glm::translate(pose, Vec3(shifts[i]));
    if (!rotations.empty()) {
      const glm::dquat rotation(rotations[i].w, rotations[i].x, rotations[i].y, rotations[i].z);
      if (!(glm::length(rotation) > 1e-9)) {
        gltf_fail(path, fmt::format("the rotation of instance {} has no length", i));
      }
      pose = pose * glm::mat4_cast(glm::normalize(rotation));
    }
    if (!scales.empty()) pose = glm::scale(pose, Vec3(scales[i]));
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace earthshine::scenes
