// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/gltf/writer.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>

#include "base/error.h"

namespace earthshine::scenes {
namespace {

// Appends values as a buffer view and an accessor; returns the accessor's index.
template <class Number>
int add_accessor(tinygltf::Model& model, const std::vector<Number>& values, int components,
                 int component_type, int target) {
  std::vector<unsigned char>& data = model.buffers.front().data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();  // all values have four bytes: always aligned
  view.byteLength = values.size() * sizeof(Number);
  view.target = target;
  data.resize(data.size() + view.byteLength);
  std::memcpy(data.data() + view.byteOffset, values.data(), view.byteLength);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size());
  accessor.componentType = component_type;
  accessor.type = components == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
  accessor.count = values.size() / static_cast<std::size_t>(components);
  model.bufferViews.push_back(view);
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size() - 1);
}

// glTF requires bounds of positions, equal to values in the buffer.
void add_bounds(tinygltf::Accessor& accessor, const std::vector<float>& positions) {
  accessor.minValues.assign(3, std::numeric_limits<double>::infinity());
  accessor.maxValues.assign(3, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double x = positions[k];
    accessor.minValues[k % 3] = std::min(accessor.minValues[k % 3], x);
    accessor.maxValues[k % 3] = std::max(accessor.maxValues[k % 3], x);
  }
}

void add_part(tinygltf::Model& model, const GltfPart& part) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = 0;
  const int position = add_accessor(model, part.positions, 3, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                    TINYGLTF_TARGET_ARRAY_BUFFER);
  add_bounds(model.accessors.back(), part.positions);
  primitive.attributes["POSITION"] = position;
  primitive.attributes["COLOR_0"] = add_accessor(
      model, part.colours, 3, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.indices = add_accessor(model, part.indices, 1, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                   TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh mesh;
  mesh.name = part.name;
  mesh.primitives.push_back(primitive);
  tinygltf::Node node;
  node.name = part.name;
  node.mesh = static_cast<int>(model.meshes.size());
  model.meshes.push_back(std::move(mesh));
  model.nodes.front().children.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(std::move(node));
}

tinygltf::Material unlit_material() {
  tinygltf::Material material;
  material.name = "light as computed";
  // Fallback for viewers without the extension, as it recommends.
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
  return material;
}

tinygltf::Value extras(std::span<const GltfNote> notes) {
  tinygltf::Value::Object object;
  for (const GltfNote& note : notes) {
    std::visit([&](const auto& value) { object[note.first] = tinygltf::Value(value); },
               note.second);
  }
  return tinygltf::Value(object);
}

}  // namespace

std::string make_glb(const std::string& name, std::span<const GltfPart> parts,
                     std::span<const GltfNote> notes) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = own_generator;
  model.extensionsUsed = {"KHR_materials_unlit"};
  model.materials.push_back(unlit_material());
  tinygltf::Node root;
  root.name = name;
  root.matrix = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};  // (x, y, z) to (x, z, -y)
  root.extras = extras(notes);
  model.nodes.push_back(std::move(root));
  std::size_t bytes = 0;
  for (const GltfPart& part : parts) {
    bytes += 4 * (part.positions.size() + part.colours.size() + part.indices.size());
  }
  // Lengths in the file have 32 bits; the JSON text needs some of them.
  if (bytes > (std::size_t{4} << 30) - (std::size_t{64} << 20)) {
    throw base::Error(base::Blame::Work, "GLB",
                      "the mesh is larger than 4 GiB, which GLB cannot hold", {},
                      "Raise quality.patch_edge");
  }
  if (bytes > 0) model.buffers.emplace_back();
  for (const GltfPart& part : parts) {
    if (!part.indices.empty()) add_part(model, part);
  }
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes.push_back(scene);
  model.defaultScene = 0;
  std::ostringstream out;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true)) {
    throw base::Error(base::Blame::Work, "GLB", "tinygltf could not write the mesh");
  }
  return std::move(out).str();
}

}  // namespace earthshine::scenes
