// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "base/error.h"
#include "base/files/hdf5_handle.h"
#include "base/numbers/digest.h"

namespace earthshine::base {
namespace {

constexpr std::size_t growth_bytes = std::size_t{4} << 20;
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
constexpr std::size_t worth_packing_bytes = 4096;

Hdf5Handle text_type(std::size_t size) {
  Hdf5Handle type = hdf5_made(Hdf5Handle(H5Tcopy(H5T_C_S1), H5Tclose));
  hdf5_made(H5Tset_size(type.id(), std::max<std::size_t>(1, size)));
  hdf5_made(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
  hdf5_made(H5Tset_cset(type.id(), H5T_CSET_UTF8));
  return type;
}

void write_attribute(hid_t to, const std::string& name, const Hdf5Value& value) {
  const Hdf5Handle space = hdf5_made(Hdf5Handle(H5Screate(H5S_SCALAR), H5Sclose));
  const auto write = [&](hid_t type, const void* data) {
    const Hdf5Handle attribute = hdf5_made(Hdf5Handle(
        H5Acreate2(to, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose));
    hdf5_made(H5Awrite(attribute.id(), type, data));
  };
  if (const auto* text = std::get_if<std::string>(&value)) {
    write(text_type(text->size()).id(), text->c_str());
  } else if (const auto* number = std::get_if<double>(&value)) {
    write(H5T_IEEE_F64LE, number);
  } else {
    write(H5T_STD_U64LE, &std::get<std::uint64_t>(value));
  }
}

std::size_t count_of(const Hdf5Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

// Without creation times, so that equal data give equal bytes.
Hdf5Handle timeless(hid_t kind) {
  Hdf5Handle properties = hdf5_made(Hdf5Handle(H5Pcreate(kind), H5Pclose));
  hdf5_made(H5Pset_obj_track_times(properties.id(), false));
  return properties;
}

// Chunks of whole rows, compressed if the data set is large enough and the library has deflate.
Hdf5Handle dataset_properties(const Hdf5Shape& shape, std::size_t value_bytes) {
  Hdf5Handle properties = timeless(H5P_DATASET_CREATE);
  const std::size_t total = count_of(shape) * value_bytes;
  if (total < worth_packing_bytes || H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0) return properties;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  chunk[0] = std::clamp<std::size_t>(chunk_bytes / (total / shape[0]), 1, shape[0]);
  hdf5_made(H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()));
  hdf5_made(H5Pset_shuffle(properties.id()));
  hdf5_made(H5Pset_deflate(properties.id(), 1));
  return properties;
}

void make_groups(hid_t file, const std::string& name) {
  for (std::size_t slash = name.find('/'); slash != std::string::npos;
       slash = name.find('/', slash + 1)) {
    const std::string group = name.substr(0, slash);
    if (H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0) continue;
    hdf5_made(Hdf5Handle(
        H5Gcreate2(file, group.c_str(), H5P_DEFAULT, timeless(H5P_GROUP_CREATE).id(), H5P_DEFAULT),
        H5Gclose));
  }
}

Hdf5Handle make_dataset(hid_t file, const std::string& name, hid_t type, const Hdf5Shape& shape,
                        const Hdf5Meaning& meaning) {
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const Hdf5Handle space = hdf5_made(Hdf5Handle(
      H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose));
  make_groups(file, name);
  Hdf5Handle set = hdf5_made(
      Hdf5Handle(H5Dcreate2(file, name.c_str(), type, space.id(), H5P_DEFAULT,
                            dataset_properties(shape, H5Tget_size(type)).id(), H5P_DEFAULT),
                 H5Dclose));
  if (!meaning.unit.empty()) write_attribute(set.id(), "unit", std::string(meaning.unit));
  if (!meaning.meaning.empty()) write_attribute(set.id(), "meaning", std::string(meaning.meaning));
  return set;
}

}  // namespace

std::string hdf5_reason() {
  std::string text = "no reason given";
  const auto take = [](unsigned depth, const H5E_error2_t* error, void* out) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text;
}

void hdf5_fail() { throw Error(Blame::Work, "HDF5", hdf5_reason()); }

hid_t hdf5_type(Hdf5Number number) {
  switch (number) {
    case Hdf5Number::Uint8:
      return H5T_STD_U8LE;
    case Hdf5Number::Uint32:
      return H5T_STD_U32LE;
    case Hdf5Number::Uint64:
      return H5T_STD_U64LE;
    case Hdf5Number::Float32:
      return H5T_IEEE_F32LE;
    case Hdf5Number::Float64:
      return H5T_IEEE_F64LE;
  }
  return H5I_INVALID_HID;
}

Hdf5Handle hdf5_memory_access() {
  hdf5_made(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
  Hdf5Handle access = hdf5_made(Hdf5Handle(H5Pcreate(H5P_FILE_ACCESS), H5Pclose));
  hdf5_made(H5Pset_fapl_core(access.id(), growth_bytes, false));
  // The oldest layout: the superblock of later ones has a checksum, which H5Fget_file_image of HDF5
  // 1.10 computes wrongly.
  hdf5_made(H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18));
  return access;
}

std::string hdf5_seal(std::string_view content) {
  Digest digest;
  digest.add(content);
  std::string block = fmt::format("Earthshine: HDF5 follows after {} bytes\nseal {}\n",
                                  hdf5_block_bytes, digest.text());
  block.resize(hdf5_block_bytes, '\0');
  return block;
}

struct Hdf5Writer::File {
  Hdf5Handle handle;
};

Hdf5Writer::Hdf5Writer() {
  const Hdf5Handle access = hdf5_memory_access();
  const Hdf5Handle creation = timeless(H5P_FILE_CREATE);
  // The name is required, but no file is created.
  file_ = std::make_unique<File>(File{hdf5_made(
      Hdf5Handle(H5Fcreate("memory", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose))});
}

Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::write(const std::string& name, const void* values, Hdf5Number number,
                       const Hdf5Shape& shape, const Hdf5Meaning& meaning) {
  const hid_t type = hdf5_type(number);
  const Hdf5Handle set = make_dataset(file_->handle.id(), name, type, shape, meaning);
  if (count_of(shape) == 0) return;
  hdf5_made(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

void Hdf5Writer::texts(const std::string& name, const std::vector<std::string>& values,
                       const Hdf5Meaning& meaning) {
  std::size_t width = 1;
  for (const std::string& value : values) width = std::max(width, value.size());
  std::string table(width * values.size(), '\0');
  for (std::size_t k = 0; k < values.size(); ++k) values[k].copy(&table[k * width], width);
  const Hdf5Handle type = text_type(width);
  const Hdf5Handle set =
      make_dataset(file_->handle.id(), name, type.id(), {values.size()}, meaning);
  if (values.empty()) return;
  hdf5_made(H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, table.data()));
}

void Hdf5Writer::attribute(const std::string& name, const Hdf5Value& value) {
  write_attribute(file_->handle.id(), name, value);
}

std::string Hdf5Writer::finish() {
  hdf5_made(H5Fflush(file_->handle.id(), H5F_SCOPE_GLOBAL));
  const auto size =
      static_cast<std::size_t>(hdf5_made(H5Fget_file_image(file_->handle.id(), nullptr, 0)));
  std::string bytes(hdf5_block_bytes + size, '\0');
  hdf5_made(H5Fget_file_image(file_->handle.id(), bytes.data() + hdf5_block_bytes, size));
  file_.reset();
  hdf5_seal(std::string_view(bytes).substr(hdf5_block_bytes)).copy(bytes.data(), hdf5_block_bytes);
  return bytes;
}

}  // namespace earthshine::base
