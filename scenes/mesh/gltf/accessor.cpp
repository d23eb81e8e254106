// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/free_memory.h"
#include "scenes/mesh/gltf/file.h"
#include "scenes/mesh/gltf/model.h"

namespace earthshine::scenes {
namespace {

// Offsets, counts and strides come from the file: 64-bit sums of them overflow, 128-bit sums do
// not.
__extension__ using Wide = unsigned __int128;

constexpr std::size_t most_elements = 3 * max_gltf_triangles;

// `count` elements of `size` bytes, `stride` apart, all of them inside the buffer.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  [[nodiscard]] const unsigned char* operator[](std::size_t i) const { return first + stride * i; }
};

std::size_t unsigned_of(const std::filesystem::path& path, std::int64_t value,
                        std::string_view what) {
  // tinygltf keeps 32 bits of a number: a large one turns up as a negative one.
  if (value < 0) {
    gltf_fail(path, fmt::format("{} is negative, or too large", what),
              "it is from 0 to 2147483647");
  }
  return static_cast<std::size_t>(value);
}

Elements view_elements(const GltfModel& model, int view_number, std::size_t offset,
                       std::size_t count, std::size_t size, bool may_have_stride,
                       const std::filesystem::path& path) {
  const std::size_t v = unsigned_of(path, view_number, "a buffer view number");
  if (v >= model.views.size()) {
    gltf_fail(path, fmt::format("buffer view {} does not exist", v),
              fmt::format("the file has {}", model.views.size()));
  }
  const GltfView& view = model.views[v];
  const std::size_t b = unsigned_of(path, view.buffer, "a buffer number");
  if (b >= model.buffers.size()) {
    gltf_fail(path, fmt::format("buffer {} does not exist", b),
              fmt::format("the file has {}", model.buffers.size()));
  }
  const std::vector<unsigned char>& data = model.buffers[b];
  const std::size_t stride = may_have_stride && view.stride != 0 ? view.stride : size;
  const Wide view_end = Wide(view.offset) + Wide(view.length);
  const Wide last = Wide(offset) + Wide(stride) * Wide(count == 0 ? 0 : count - 1) + Wide(size);
  if (stride < size || view_end > data.size() || (count > 0 && last > view.length)) {
    gltf_fail(path, fmt::format("an accessor of {} elements leaves its buffer", count),
              fmt::format("buffer view {} holds {} bytes", v, view.length));
  }
  if (count == 0) return {};
  return {data.data() + view.offset + offset, stride};
}

const GltfAccessor& accessor_at(const GltfModel& model, int number,
                                const std::filesystem::path& path) {
  if (number < 0 || static_cast<std::size_t>(number) >= model.accessors.size()) {
    gltf_fail(path, fmt::format("accessor {} does not exist", number),
              fmt::format("the file has {}", model.accessors.size()));
  }
  const GltfAccessor& accessor = model.accessors[static_cast<std::size_t>(number)];
  if (accessor.count > most_elements) {
    gltf_fail(path, fmt::format("an accessor of {} elements", accessor.count),
              fmt::format("at most {} are read", most_elements));
  }
  return accessor;
}

std::size_t index_bytes(GltfNumber number, const std::filesystem::path& path) {
  if (number == GltfNumber::Uint8) return 1;
  if (number == GltfNumber::Uint16) return 2;
  if (number == GltfNumber::Uint32) return 4;
  gltf_fail(path, "indices of a type that is none", "indices are unsigned bytes, shorts or ints");
}

// Little-endian, as are the machines this runs on.
std::uint32_t index_at(const unsigned char* bytes, std::size_t size) {
  std::uint32_t index = 0;
  std::memcpy(&index, bytes, size);
  return index;
}

std::size_t number_bytes(GltfNumber number) {
  if (number == GltfNumber::Int8 || number == GltfNumber::Uint8) return 1;
  return number == GltfNumber::Int16 || number == GltfNumber::Uint16 ? 2 : 4;
}

template <class Number>
double whole_at(const unsigned char* bytes, bool normalized) {
  Number value = 0;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalized) return static_cast<double>(value);
  // glTF 2.0, 3.6.2.2: the least negative number stands for -1 too.
  return std::max(-1.0, static_cast<double>(value) / std::numeric_limits<Number>::max());
}

double number_at(const unsigned char* bytes, GltfNumber number, bool normalized) {
  if (number == GltfNumber::Int8) return whole_at<std::int8_t>(bytes, normalized);
  if (number == GltfNumber::Uint8) return whole_at<std::uint8_t>(bytes, normalized);
  if (number == GltfNumber::Int16) return whole_at<std::int16_t>(bytes, normalized);
  if (number == GltfNumber::Uint16) return whole_at<std::uint16_t>(bytes, normalized);
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof value);
  return double(value);
}

// The first `components` numbers; the rest are 0.
Vec3 vector_at(const unsigned char* bytes, const GltfAccessor& accessor, std::string_view attribute,
               const std::filesystem::path& path) {
  Vec3 v(0.0);
  const std::size_t size = number_bytes(accessor.number);
  for (int c = 0; c < accessor.components; ++c) {
    v[c] =
        number_at(bytes + size * static_cast<std::size_t>(c), accessor.number, accessor.normalized);
    if (std::abs(v[c]) <= largest_coordinate) continue;
    gltf_fail(path, fmt::format("the {} of a vertex has {}", attribute, v[c]),
              fmt::format("its numbers are finite and at most {}", largest_coordinate));
  }
  return v;
}

// Calls write(index, bytes) for each element that a sparse accessor replaces.
template <class Write>
void each_sparse(const GltfModel& model, const GltfAccessor& accessor, std::size_t value_size,
                 const std::filesystem::path& path, Write write) {
  if (!accessor.sparse) return;
  const GltfSparse& sparse = *accessor.sparse;
  const std::size_t count = unsigned_of(path, sparse.count, "a sparse count");
  const std::size_t size = index_bytes(sparse.index_number, path);
  const Elements indices = view_elements(model, sparse.index_view,
                                         unsigned_of(path, sparse.index_offset, "a byte offset"),
                                         count, size, false, path);
  const Elements values = view_elements(model, sparse.value_view,
                                        unsigned_of(path, sparse.value_offset, "a byte offset"),
                                        count, value_size, false, path);
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

std::vector<Vec3> read_gltf_vectors(const GltfModel& model, int number, int components,
                                    std::string_view attribute, const std::filesystem::path& path) {
  const GltfAccessor& accessor = accessor_at(model, number, path);
  const bool is_number =
      accessor.number != GltfNumber::Uint32 && accessor.number != GltfNumber::Other;
  if (accessor.components != components || !is_number) {
    gltf_fail(path, fmt::format("{} that is not {} numbers", attribute, components),
              fmt::format("{} is VEC{} of floats, or of quantised bytes or shorts", attribute,
                          components));
  }
  const std::size_t size = static_cast<std::size_t>(components) * number_bytes(accessor.number);
  std::vector<Vec3> vectors;
  base::check_room(accessor.count * sizeof(Vec3), path.string());
  if (accessor.view != -1) {
    const Elements elements =
        view_elements(model, accessor.view, accessor.offset, accessor.count, size, true, path);
    vectors.reserve(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      vectors.push_back(vector_at(elements[i], accessor, attribute, path));
    }
  } else {
    vectors.assign(accessor.count, Vec3(0.0));  // zeros by the specification, unless sparse
  }
  each_sparse(model, accessor, size, path, [&](std::size_t i, const unsigned char* bytes) {
    vectors[i] = vector_at(bytes, accessor, attribute, path);
  });
  return vectors;
}

std::vector<std::uint32_t> read_gltf_indices(const GltfModel& model, int number,
                                             const std::filesystem::path& path) {
  const GltfAccessor& accessor = accessor_at(model, number, path);
  if (accessor.components != 1) {
    gltf_fail(path, "indices that are not single numbers", "an index accessor is SCALAR");
  }
  const std::size_t size = index_bytes(accessor.number, path);
  std::vector<std::uint32_t> indices;
  if (accessor.view != -1) {
    const Elements elements =
        view_elements(model, accessor.view, accessor.offset, accessor.count, size, true, path);
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

}  // namespace earthshine::scenes
