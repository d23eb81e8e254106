// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "base/error.h"
#include "base/files/hdf5_handle.h"

namespace earthshine::base {
namespace {

constexpr std::size_t longest_text = std::size_t{1} << 16;
// Deflate compresses by at most a factor of 1032.
constexpr std::size_t most_unpacked = 1100;

std::string shape_text(const Hdf5Shape& shape) {
  return fmt::format("{}", fmt::join(shape, " x "));
}

bool is_text(hid_t type) {
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
         H5Tget_size(type) > 0 && H5Tget_size(type) <= longest_text;
}

// Without the zeros that pad it.
std::string text_at(const std::string& table, std::size_t at, std::size_t width) {
  const std::string text = table.substr(at, width);
  return text.substr(0, text.find('\0'));
}

}  // namespace

struct Hdf5Reader::File {
  Hdf5Handle handle;
  std::size_t bytes = 0;

  // The data set of that name; an invalid handle if it is missing or not stored in this file. Soft
  // and external links, external storage and virtual data sets could read other files.
  [[nodiscard]] Hdf5Handle open(const std::string& name) const {
    for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
      H5L_info_t link{};
      if (H5Lget_info(handle.id(), name.substr(0, end).c_str(), &link, H5P_DEFAULT) < 0 ||
          link.type != H5L_TYPE_HARD) {
        return {H5I_INVALID_HID, H5Dclose};
      }
      if (end == std::string::npos) break;
    }
    Hdf5Handle set(H5Dopen2(handle.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) return set;
    const Hdf5Handle properties(H5Dget_create_plist(set.id()), H5Pclose);
    const H5D_layout_t layout = H5Pget_layout(properties.id());
    const bool inside = layout == H5D_COMPACT || layout == H5D_CHUNKED ||
                        (layout == H5D_CONTIGUOUS && H5Pget_external_count(properties.id()) == 0);
    if (!inside) return {H5I_INVALID_HID, H5Dclose};
    return set;
  }

  [[nodiscard]] Hdf5Handle open_attribute(const std::string& name) const {
    return {H5Aopen(handle.id(), name.c_str(), H5P_DEFAULT), H5Aclose};
  }
};

Hdf5Reader::Hdf5Reader(std::string bytes, std::string name) : name_(std::move(name)) {
  const std::string_view all = bytes;
  if (!all.starts_with("Earthshine: HDF5") || all.size() <= hdf5_block_bytes) {
    fail("it has no seal");
  }
  if (all.substr(0, hdf5_block_bytes) != hdf5_seal(all.substr(hdf5_block_bytes))) {
    fail("its seal is broken: it was cut off or changed after it was written");
  }
  const Hdf5Handle access = hdf5_memory_access();
  hdf5_made(H5PLset_loading_state(0));  // forbids plug-ins: a file must not load code
  // The library copies the bytes.
  hdf5_made(H5Pset_file_image(access.id(), bytes.data() + hdf5_block_bytes,
                              bytes.size() - hdf5_block_bytes));
  Hdf5Handle handle(H5Fopen("memory", H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!handle.valid()) fail(hdf5_reason());
  file_ = std::make_unique<File>(File{std::move(handle), bytes.size()});
}

Hdf5Reader::~Hdf5Reader() = default;

void Hdf5Reader::fail(const std::string& found) const {
  throw Error(Blame::Input, name_, "is not a sound file of this program: " + found, {},
              "Write it again with the command that made it");
}

Hdf5Shape Hdf5Reader::shape(const std::string& name) const {
  const Hdf5Handle set = file_->open(name);
  if (!set.valid()) fail(fmt::format("there is no \"{}\"", name));
  const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0) fail(fmt::format("\"{}\" has no extent", name));
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

std::size_t Hdf5Reader::checked_count(const std::string& name, Hdf5Number number,
                                      const Hdf5Shape& expected) const {
  const Hdf5Shape found = shape(name);
  if (found != expected) {
    fail(fmt::format("\"{}\" is {}, expected {}", name, shape_text(found), shape_text(expected)));
  }
  const Hdf5Handle set = file_->open(name);
  const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
  if (H5Tequal(type.id(), hdf5_type(number)) <= 0) {
    fail(fmt::format("\"{}\" holds another kind of number", name));
  }
  std::size_t count = 1;
  for (const std::size_t extent : expected) {
    if (extent == 0) return 0;
    if (count > std::numeric_limits<std::size_t>::max() / extent) fail("it is too large");
    count *= extent;
  }
  // A small file may claim any shape; the library would return zeros for missing data.
  const std::size_t stored = std::min<std::size_t>(H5Dget_storage_size(set.id()), file_->bytes);
  if (count / most_unpacked > stored / H5Tget_size(type.id())) {
    fail(fmt::format("\"{}\" was not stored in full", name));
  }
  return count;
}

void Hdf5Reader::read(const std::string& name, void* values, Hdf5Number number) const {
  const Hdf5Handle set = file_->open(name);
  const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.id()) == 0) return;
  if (H5Dread(set.id(), hdf5_type(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    fail(fmt::format("\"{}\": {}", name, hdf5_reason()));
  }
}

std::vector<std::string> Hdf5Reader::texts(const std::string& name) const {
  const Hdf5Shape extent = shape(name);
  const Hdf5Handle set = file_->open(name);
  const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
  if (!is_text(type.id()) || extent.size() != 1) {
    fail(fmt::format("\"{}\" is no list of texts", name));
  }
  const std::size_t width = H5Tget_size(type.id());
  const std::size_t stored = std::min<std::size_t>(H5Dget_storage_size(set.id()), file_->bytes);
  if (extent[0] / most_unpacked > stored / width) {
    fail(fmt::format("\"{}\" was not stored in full", name));
  }
  std::string table(extent[0] * width, '\0');
  if (!table.empty() &&
      H5Dread(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, table.data()) < 0) {
    fail(fmt::format("\"{}\": {}", name, hdf5_reason()));
  }
  std::vector<std::string> values;
  for (std::size_t k = 0; k < extent[0]; ++k) values.push_back(text_at(table, k * width, width));
  return values;
}

std::string Hdf5Reader::text_attribute(const std::string& name) const {
  const Hdf5Handle attribute = file_->open_attribute(name);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute.id()) : H5I_INVALID_HID,
                        H5Tclose);
  if (!type.valid() || !is_text(type.id()) ||
      H5Aget_storage_size(attribute.id()) != H5Tget_size(type.id())) {
    fail(fmt::format("it has no text \"{}\"", name));
  }
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) fail(hdf5_reason());
  return text_at(text, 0, text.size());
}

bool Hdf5Reader::has_attribute(const std::string& name) const {
  return file_->open_attribute(name).valid();
}

double Hdf5Reader::number_attribute(const std::string& name) const {
  double value = 0.0;
  read_attribute(name, &value, Hdf5Number::Float64);
  return value;
}

std::uint64_t Hdf5Reader::count_attribute(const std::string& name) const {
  std::uint64_t value = 0;
  read_attribute(name, &value, Hdf5Number::Uint64);
  return value;
}

void Hdf5Reader::read_attribute(const std::string& name, void* value, Hdf5Number number) const {
  const Hdf5Handle attribute = file_->open_attribute(name);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute.id()) : H5I_INVALID_HID,
                        H5Tclose);
  if (!type.valid() || H5Tequal(type.id(), hdf5_type(number)) <= 0 ||
      H5Aget_storage_size(attribute.id()) != H5Tget_size(type.id())) {
    fail(fmt::format("it has no number \"{}\"", name));
  }
  if (H5Aread(attribute.id(), hdf5_type(number), value) < 0) fail(hdf5_reason());
}

}  // namespace earthshine::base
