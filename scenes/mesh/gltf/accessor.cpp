// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "base/free_memory.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/model.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

// Offsets, counts and strides come from the file. Their 64-bit sums could overflow; 128-bit sums
// cannot.
__extension__ using Wide = unsigned __int128;

constexpr std::size_t most_elements = 3 * max_gltf_triangles;

// `count` elements of `size` bytes at distance `stride`, all inside the buffer.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  [[nodiscard]] const unsigned char* operator[](std::size_t i) const { return first + stride * i; }
};

Elements view_elements(const GltfModel& model, int view_number, std::size_t offset,
                       std::size_t count, std::size_t size, bool may_have_stride,
                       const std::filesystem::path& path) {
  const std::size_t v = static_cast<std::size_t>(view_number);
  if (v >= model.file.bufferViews.size()) {
    gltf_fail(path, fmt::format("buffer view {} does not exist", v),
              fmt::format("the file has {}", model.file.bufferViews.size()));
  }
  const tinygltf::BufferView& view = model.file.bufferViews[v];
  const std::size_t b = static_cast<std::size_t>(view.buffer);
  if (b >= model.file.buffers.size()) {
    gltf_fail(path, fmt::format("buffer {} does not exist", b),
              fmt::format("the file has {}", model.file.buffers.size()));
  }
  const std::vector<unsigned char>& data = model.file.buffers[b].data;
  const std::size_t stride = may_have_stride && view.byteStride != 0 ? view.byteStride : size;
  const Wide view_end = Wide(view.byteOffset) + Wide(view.byteLength);
  const Wide last = Wide(offset) + Wide(stride) * Wide(count == 0 ? 0 : count - 1) + Wide(size);
  if (stride < size || view_end > data.size() || (count > 0 && last > view.byteLength)) {
    gltf_fail(path, fmt::format("an accessor of {} elements leaves its buffer", count),
              fmt::format("buffer view {} holds {} bytes", v, view.byteLength));
  }
  if (count == 0) return {};
  return {data.data() + view.byteOffset + offset, stride};
}

const tinygltf::Accessor& accessor_at(const GltfModel& model, int number,
                                      const std::filesystem::path& path) {
  if (number < 0 || static_cast<std::size_t>(number) >= model.file.accessors.size()) {
    gltf_fail(path, fmt::format("accessor {} does not exist", number),
              fmt::format("the file has {}", model.file.accessors.size()));
  }
  const tinygltf::Accessor& accessor = model.file.accessors[static_cast<std::size_t>(number)];
  if (accessor.count > most_elements) {
    gltf_fail(path, fmt::format("an accessor of {} elements", accessor.count),
              fmt::format("at most {} are read", most_elements));
  }
  return accessor;
}

std::size_t index_bytes(int type, const std::filesystem::path& path) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return 1;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return 2;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return 4;
  gltf_fail(path, "indices of a type that is none", "indices are unsigned bytes, shorts or ints");
}

// Little-endian, as all supported machines are.
std::uint32_t index_at(const unsigned char* bytes, std::size_t size) {
  std::uint32_t index = 0;
  std::memcpy(&index, bytes, size);
  return index;
}

template <class Number>
double whole_at(const unsigned char* bytes, bool normalized) {
  Number value = 0;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalized) return static_cast<double>(value);
  // glTF 2.0, 3.6.2.2: the most negative number also represents -1.
  return std::max(-1.0, static_cast<double>(value) / std::numeric_limits<Number>::max());
}

double number_at(const unsigned char* bytes, int type, bool normalized) {
  if (type == TINYGLTF_COMPONENT_TYPE_BYTE) return whole_at<std::int8_t>(bytes, normalized);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) {
    return whole_at<std::uint8_t>(bytes, normalized);
  }
  if (type == TINYGLTF_COMPONENT_TYPE_SHORT) return whole_at<std::int16_t>(bytes, normalized);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
    return whole_at<std::uint16_t>(bytes, normalized);
  }
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof value);
  return double(value);
}

std::size_t number_bytes(const tinygltf::Accessor& accessor) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
}

int components_of(const tinygltf::Accessor& accessor) {
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
}

// The accessor's components; missing ones are 0, a missing fourth one is 1.
glm::dvec4 vector_at(const unsigned char* bytes, const tinygltf::Accessor& accessor,
                     const GltfAttribute& attribute, const std::filesystem::path& path) {
  glm::dvec4 v(0.0, 0.0, 0.0, 1.0);
  for (int c = 0; c < components_of(accessor); ++c) {
    v[c] = number_at(bytes + number_bytes(accessor) * static_cast<std::size_t>(c),
                     accessor.componentType, accessor.normalized || attribute.is_share);
    if (std::abs(v[c]) <= largest_coordinate) continue;
    gltf_fail(path, fmt::format("the {} of a vertex has {}", attribute.name, v[c]),
              fmt::format("its numbers are finite and at most {}", largest_coordinate));
  }
  return v;
}

// Calls write(index, bytes) for each element that a sparse accessor replaces.
template <class Write>
void each_sparse(const GltfModel& model, const tinygltf::Accessor& accessor, std::size_t value_size,
                 const std::filesystem::path& path, Write write) {
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  const std::size_t count = static_cast<std::size_t>(sparse.count);
  const std::size_t size = index_bytes(sparse.indices.componentType, path);
  const auto elements = [&](const auto& from, std::size_t bytes) {
    return view_elements(model, from.bufferView, static_cast<std::size_t>(from.byteOffset), count,
                         bytes, false, path);
  };
  const Elements indices = elements(sparse.indices, size);
  const Elements values = elements(sparse.values, value_size);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = index_at(indices[i], size);
    if (index >= accessor.count) {
      gltf_fail(path, fmt::format("a sparse accessor replaces element {}", index),
                fmt::format("it has {} elements", accessor.count));
    }
    write(index, values[i]);
  }
}

}  // namespace

namespace {

template <class Vector>
std::vector<Vector> read_vectors(const GltfModel& model, int number, const GltfAttribute& attribute,
                                 const std::filesystem::path& path) {
  const tinygltf::Accessor& accessor = accessor_at(model, number, path);
  const int type = accessor.componentType, components = components_of(accessor);
  const bool is_number =
      (type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) ||
      type == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool fits = components >= attribute.least && components <= attribute.most;
  if (!fits || !is_number) {
    const std::string wanted = attribute.least == attribute.most
                                   ? fmt::format("{}", attribute.most)
                                   : fmt::format("{} or {}", attribute.least, attribute.most);
    gltf_fail(path, fmt::format("{} that is not {} numbers", attribute.name, wanted),
              fmt::format("{} is VEC{} of floats, or of quantised bytes or shorts", attribute.name,
                          wanted));
  }
  const std::size_t size = static_cast<std::size_t>(components) * number_bytes(accessor);
  std::vector<Vector> vectors;
  base::check_room(accessor.count * sizeof(Vector), path.string());
  if (accessor.bufferView != -1) {
    const Elements elements = view_elements(model, accessor.bufferView, accessor.byteOffset,
                                            accessor.count, size, true, path);
    vectors.reserve(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      vectors.emplace_back(vector_at(elements[i], accessor, attribute, path));
    }
  } else {
    vectors.assign(accessor.count, Vector(0.0));  // zeros by the specification, unless sparse
  }
  each_sparse(model, accessor, size, path, [&](std::size_t i, const unsigned char* bytes) {
    vectors[i] = Vector(vector_at(bytes, accessor, attribute, path));
  });
  return vectors;
}

}  // namespace

std::vector<Vec3> read_gltf_vectors(const GltfModel& model, int number, int components,
                                    std::string_view name, const std::filesystem::path& path) {
  return read_vectors<Vec3>(model, number, {name, components, components}, path);
}

std::vector<glm::dvec4> read_gltf_fours(const GltfModel& model, int number,
                                        const GltfAttribute& attribute,
                                        const std::filesystem::path& path) {
  return read_vectors<glm::dvec4>(model, number, attribute, path);
}

std::vector<glm::dmat4> read_gltf_matrices(const GltfModel& model, int number,
                                           const std::filesystem::path& path) {
  const tinygltf::Accessor& accessor = accessor_at(model, number, path);
  if (accessor.type != TINYGLTF_TYPE_MAT4 ||
      accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.bufferView == -1) {
    gltf_fail(path, "inverse bind matrices that are none", "they are MAT4 of floats");
  }
  constexpr std::size_t size = 16 * sizeof(float);
  base::check_room(accessor.count * sizeof(glm::dmat4), path.string());
  const Elements elements = view_elements(model, accessor.bufferView, accessor.byteOffset,
                                          accessor.count, size, true, path);
  std::vector<glm::dmat4> matrices(accessor.count);
  for (std::size_t i = 0; i < accessor.count; ++i) {
    for (int k = 0; k < 16; ++k) {
      const double x = number_at(elements[i] + sizeof(float) * static_cast<std::size_t>(k),
                                 accessor.componentType, false);
      if (!(std::abs(x) <= largest_coordinate)) {
        gltf_fail(path, fmt::format("an inverse bind matrix has {}", x), "its numbers are finite");
      }
      matrices[i][k / 4][k % 4] = x;
    }
  }
  return matrices;
}

std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int number,
                                             const std::filesystem::path& path) {
  const tinygltf::Accessor& accessor = accessor_at(model, number, path);
  if (components_of(accessor) != 1) {
    gltf_fail(path, "indices that are not single numbers", "an index accessor is SCALAR");
  }
  const std::size_t size = index_bytes(accessor.componentType, path);
  std::vector<std::uint32_t> indices;
  if (accessor.bufferView != -1) {
    const Elements elements = view_elements(model, accessor.bufferView, accessor.byteOffset,
                                            accessor.count, size, true, path);
    indices.reserve(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) indices.push_back(index_at(elements[i], size));
  } else {
    indices.assign(accessor.count, 0);
  }
  each_sparse(model, accessor, size, path, [&](std::size_t i, const unsigned char* bytes) {
    indices[i] = index_at(bytes, size);
  });
  return indices;
}

glm::dmat4 node_matrix(const tinygltf::Node& node, const std::filesystem::path& path) {
  const auto check = [&](const std::vector<double>& values, std::size_t wanted,
                         std::string_view what) {
    const bool finite = std::all_of(values.begin(), values.end(),
                                    [](double x) { return std::abs(x) <= largest_coordinate; });
    if ((values.empty() || values.size() == wanted) && finite) return;
    gltf_fail(path, fmt::format("the {} of node {}", what, in_quotes(node.name)),
              fmt::format("it has {} finite numbers", wanted));
  };
  check(node.matrix, 16, "matrix");
  check(node.translation, 3, "translation");
  check(node.rotation, 4, "rotation");
  check(node.scale, 3, "scale");
  glm::dmat4 matrix(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    const glm::dvec4 last = glm::row(matrix, 3);
    if (glm::distance(last, glm::dvec4(0.0, 0.0, 0.0, 1.0)) > 1e-5) {
      gltf_fail(path,
                fmt::format("the matrix of node {} is of a projection: its last row is {} {} {} {}",
                            in_quotes(node.name), last.x, last.y, last.z, last.w),
                "the last row is 0 0 0 1");
    }
    return matrix;
  }
  if (!node.translation.empty()) {
    matrix =
        glm::translate(matrix, Vec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (!node.rotation.empty()) {
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                              node.rotation[2]);
    if (!(glm::length(rotation) > 1e-9)) {
      gltf_fail(path, fmt::format("the rotation of node {} has no length", in_quotes(node.name)));
    }
    matrix = matrix * glm::mat4_cast(glm::normalize(rotation));
  }
  if (!node.scale.empty()) {
    matrix = glm::scale(matrix, Vec3(node.scale[0], node.scale[1], node.scale[2]));
  }
  return matrix;
}

}  // namespace earthshine::scenes
