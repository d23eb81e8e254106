// SPDX-License-Identifier: Apache-2.0
// Shared by hdf5_writer.cpp and hdf5_reader.cpp, the only users of the library.
#pragma once

#include <hdf5.h>

#include <string>
#include <string_view>
#include <utility>

#include "base/files/hdf5_file.h"

namespace earthshine::base {

// RAII: an identifier of the library.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (valid()) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;

  [[nodiscard]] bool valid() const { return id_ >= 0; }
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

// Innermost message of the library's last error.
[[nodiscard]] std::string hdf5_reason();

// Type in the file, independent of the machine.
[[nodiscard]] hid_t hdf5_type(Hdf5Number number);

// Access properties for a file in memory. Also switches off the library's error output.
[[nodiscard]] Hdf5Handle hdf5_memory_access();

inline constexpr std::size_t hdf5_block_bytes = 512;  // smallest user block that HDF5 allows
// The user block for this content.
[[nodiscard]] std::string hdf5_seal(std::string_view content);

// Throw base::Error (Work) with the library's message if an identifier or a result is negative.
[[noreturn]] void hdf5_fail();
template <class Result>
Result hdf5_made(Result result) {
  if (result < 0) hdf5_fail();
  return result;
}
inline Hdf5Handle hdf5_made(Hdf5Handle handle) {
  if (!handle.valid()) hdf5_fail();
  return handle;
}

}  // namespace earthshine::base
