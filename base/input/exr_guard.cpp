// SPDX-License-Identifier: Apache-2.0
#include "base/input/exr_guard.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace earthshine::base {
namespace {

// The library reads values of these types with the size of the type, whatever size the file states.
// It would then read the next attribute from another position than this reader.
std::optional<std::uint64_t> size_of(std::string_view type) {
  constexpr std::pair<std::string_view, std::uint64_t> sizes[] = {{"box2i", 16},
                                                                  {"box2f", 16},
                                                                  {"chromaticities", 32},
                                                                  {"compression", 1},
                                                                  {"double", 8},
                                                                  {"envmap", 1},
                                                                  {"deepImageState", 1},
                                                                  {"float", 4},
                                                                  {"int", 4},
                                                                  {"keycode", 28},
                                                                  {"lineOrder", 1},
                                                                  {"m33f", 36},
                                                                  {"m33d", 72},
                                                                  {"m44f", 64},
                                                                  {"m44d", 128},
                                                                  {"rational", 8},
                                                                  {"timecode", 8},
                                                                  {"tiledesc", 9},
                                                                  {"v2i", 8},
                                                                  {"v2f", 8},
                                                                  {"v2d", 16},
                                                                  {"v3i", 12},
                                                                  {"v3f", 12},
                                                                  {"v3d", 24}};
  for (const auto& [name, size] : sizes) {
    if (name == type) return size;
  }
  return {};
}

// Reads the bytes of a value from the front.
class Value {
 public:
  explicit Value(std::string_view bytes) : left_(bytes) {}
  [[nodiscard]] std::uint64_t left() const { return left_.size(); }
  [[nodiscard]] std::uint64_t number() {  // past the end: larger than any file
    if (left_.size() < 4) return std::uint64_t{1} << 40U;
    std::uint64_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8U | static_cast<unsigned char>(left_[k]);
    left_.remove_prefix(4);
    return value;
  }
  bool skip(std::uint64_t count) {
    if (count > left_.size()) return false;
    left_.remove_prefix(count);
    return true;
  }
  // Skips a name and its zero byte. Returns the length; empty if the zero byte is missing.
  std::optional<std::size_t> name() {
    const std::size_t length = left_.find('\0');
    if (length == std::string_view::npos) return {};
    left_.remove_prefix(length + 1);
    return length;
  }

 private:
  std::string_view left_;
};

// These types must be parsed; others are skipped.
bool contains_its_size(std::string_view type) {
  return type == "chlist" || type == "stringvector" || type == "preview";
}

// Whether a value that contains its own length ends at the stated size.
bool is_whole(std::string_view type, Value value) {
  if (type == "chlist") {  // names, each with 16 bytes about its channel; an empty name ends the
                           // list
    constexpr std::uint64_t bytes_per_channel = 16;
    while (true) {
      const auto length = value.name();
      if (!length) return false;
      if (*length == 0) return value.left() == 0;
      if (!value.skip(bytes_per_channel)) return false;
    }
  }
  if (type == "stringvector") {
    while (value.left() > 0) {
      if (!value.skip(value.number())) return false;
    }
  }
  if (type == "preview") {  // columns, rows, 4 bytes per pixel
    const std::uint64_t columns = value.number(), rows = value.number();
    return columns <= value.left() && rows <= value.left() && 4 * columns * rows == value.left();
  }
  return true;
}

// "Technical Introduction to OpenEXR": a magic number, a version with flags, then one header, or
// several headers and an empty one. A header is a list of attributes and ends with a zero byte. An
// attribute has a name and a type, each with a zero byte, a size in bytes and a value.
class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary) {
    std::error_code problem;
    size_ = std::filesystem::file_size(path, problem);
    if (problem) size_ = 0;
  }

  void check() {
    constexpr std::uint32_t magic = 20000630, several_parts = 0x1000;
    const std::uint32_t first = number();
    const std::uint32_t version = number();
    if (!file_ || first != magic) return;
    const bool ends_empty = (version & several_parts) != 0;
    while (header() && ends_empty && file_) {
    }
  }

 private:
  [[nodiscard]] std::uint32_t number() {
    std::array<char, 4> bytes{};
    file_.read(bytes.data(), bytes.size());
    return static_cast<std::uint32_t>(Value({bytes.data(), bytes.size()}).number());
  }

  [[nodiscard]] std::string word() {
    constexpr std::size_t most = 255;
    std::string text;
    for (int byte = file_.get(); byte > 0; byte = file_.get()) {
      if (text.size() == most) refuse("has a name of more than 255 bytes in its header");
      text += static_cast<char>(byte);
    }
    return text;
  }

  [[noreturn]] void refuse(const std::string& found) const {
    throw Error(Blame::Input, path_.string(), found, {}, "Copy it again");
  }

  // False for an empty header, which ends the list.
  bool header() {
    bool any = false;
    while (true) {
      const std::string name = word();
      if (name.empty() || !file_) return any;
      any = true;
      const std::string type = word();
      const std::uint32_t length = number();
      if (!file_) return false;
      const auto here = static_cast<std::uint64_t>(file_.tellg());
      const std::uint64_t left = size_ > here ? size_ - here : 0;
      if (length > left) {
        refuse(fmt::format("announces {} bytes of attribute \"{}\" and has {} more", length, name,
                           left));
      }
      if (const auto size = size_of(type); size && *size != length) {
        refuse(fmt::format("gives attribute \"{}\" {} bytes; its type, {}, has {}", name, length,
                           type, *size));
      }
      const bool counts_chunks = name == "chunkCount" && type == "int";
      if (!counts_chunks && !contains_its_size(type)) {
        file_.seekg(length, std::ios::cur);
        continue;
      }
      std::string value(length, '\0');
      file_.read(value.data(), static_cast<std::streamsize>(length));
      if (!file_) return false;
      if (!is_whole(type, Value(value))) {
        refuse(fmt::format("gives attribute \"{}\" {} bytes, which are not those of a {}", name,
                           length, type));
      }
      if (counts_chunks) check_chunks(Value(value).number());
    }
  }

  void check_chunks(std::uint64_t chunks) const {
    constexpr std::uint64_t bytes_per_chunk = 8;  // in the offset table
    if (chunks * bytes_per_chunk > size_) {
      refuse(fmt::format("announces {} chunks of pixels and has {} bytes", chunks, size_));
    }
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

}  // namespace

void guard_exr(const std::filesystem::path& path) { HeaderReader(path).check(); }

}  // namespace earthshine::base
