// SPDX-License-Identifier: Apache-2.0
#include "base/input/exr_guard.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>

#include "base/error.h"

namespace earthshine::base {
namespace {

// "Technical Introduction to OpenEXR": a magic number, a version with flags, then one header, or
// several of them and an empty one. A header is a row of attributes, each a name and a type, ended
// by a zero byte each, a size in bytes and a value, and ends with a zero byte.
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
    std::array<unsigned char, 4> bytes{};
    file_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    std::uint32_t value = 0;
    for (std::size_t k = bytes.size(); k-- > 0;) value = value << 8U | bytes[k];
    return value;
  }

  // Names have at most 255 bytes.
  [[nodiscard]] std::string word() {
    std::string text;
    for (int byte = file_.get(); byte > 0 && text.size() < 256; byte = file_.get()) {
      text += static_cast<char>(byte);
    }
    return text;
  }

  // False for an empty one, which ends a row of them.
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
        throw Error(Blame::Input, path_.string(),
                    "announces " + std::to_string(length) + " bytes of attribute \"" + name +
                        "\" and has " + std::to_string(left) + " more",
                    {}, "Copy it again");
      }
      if (name == "chunkCount" && type == "int" && length == 4) {
        const std::uint64_t chunks = number();
        constexpr std::uint64_t bytes_per_chunk = 8;  // of the table alone
        if (chunks * bytes_per_chunk > size_) {
          throw Error(Blame::Input, path_.string(),
                      "announces " + std::to_string(chunks) + " chunks of pixels and has " +
                          std::to_string(size_) + " bytes",
                      {}, "Copy it again");
        }
      } else {
        file_.seekg(static_cast<std::streamoff>(length), std::ios::cur);
      }
    }
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

}  // namespace

void guard_exr(const std::filesystem::path& path) { HeaderReader(path).check(); }

}  // namespace earthshine::base
