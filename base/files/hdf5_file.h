// SPDX-License-Identifier: Apache-2.0
// Writes and reads HDF5. Only hdf5_writer.cpp and hdf5_reader.cpp use the library.
//
// Files are built and parsed in memory, so that output_file.h handles all disk errors: the library
// reports a full disk only on close. A user block, which HDF5 readers skip, precedes the data and
// has a seal: the digest of the data. A changed file fails this check and never reaches the
// library, because older versions crash on corrupt files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace earthshine::base {

using Hdf5Shape = std::vector<std::size_t>;
using Hdf5Value = std::variant<std::string, double, std::uint64_t>;

enum class Hdf5Number { Uint8, Uint32, Uint64, Float32, Float64 };
template <class T>
inline constexpr Hdf5Number hdf5_number = Hdf5Number::Uint8;
template <>
inline constexpr Hdf5Number hdf5_number<std::uint32_t> = Hdf5Number::Uint32;
template <>
inline constexpr Hdf5Number hdf5_number<std::uint64_t> = Hdf5Number::Uint64;
template <>
inline constexpr Hdf5Number hdf5_number<float> = Hdf5Number::Float32;
template <>
inline constexpr Hdf5Number hdf5_number<double> = Hdf5Number::Float64;

// Attributes of a data set; empty ones are not written.
struct Hdf5Meaning {
  std::string_view unit, meaning;
};

// Names may contain groups: "ledger/emitted_lm". Equal calls give equal bytes. Throws base::Error
// (Work), for example out of memory.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  // values: in row-major order, as many as the shape has.
  template <class T>
  void array(const std::string& name, std::span<const T> values, const Hdf5Shape& shape,
             const Hdf5Meaning& meaning) {
    write(name, values.data(), hdf5_number<T>, shape, meaning);
  }
  void texts(const std::string& name, const std::vector<std::string>& values,
             const Hdf5Meaning& meaning);
  // Attribute of the whole file.
  void attribute(const std::string& name, const Hdf5Value& value);

  // Returns the file's bytes with the seal. Call it once, as the last call.
  [[nodiscard]] std::string finish();

 private:
  void write(const std::string& name, const void* values, Hdf5Number number, const Hdf5Shape& shape,
             const Hdf5Meaning& meaning);

  struct File;
  std::unique_ptr<File> file_;
};

// Every read throws base::Error (Input), with the file's name, if the data set is missing or has
// another type or shape. Allocations are bounded by the file's size.
class Hdf5Reader {
 public:
  // name: the file's name, for messages. Throws base::Error (Input) if the seal is missing or
  // wrong.
  Hdf5Reader(std::string bytes, std::string name);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Hdf5Shape shape(const std::string& name) const;
  template <class T>
  [[nodiscard]] std::vector<T> array(const std::string& name, const Hdf5Shape& expected) const {
    std::vector<T> values(checked_count(name, hdf5_number<T>, expected));
    read(name, values.data(), hdf5_number<T>);
    return values;
  }
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& name) const;
  [[nodiscard]] bool has_attribute(const std::string& name) const;
  [[nodiscard]] double number_attribute(const std::string& name) const;
  [[nodiscard]] std::uint64_t count_attribute(const std::string& name) const;

  // Throws base::Error (Input): the file is invalid.
  [[noreturn]] void fail(const std::string& found) const;

 private:
  [[nodiscard]] std::size_t checked_count(const std::string& name, Hdf5Number number,
                                          const Hdf5Shape& expected) const;
  void read(const std::string& name, void* values, Hdf5Number number) const;
  void read_attribute(const std::string& name, void* value, Hdf5Number number) const;

  struct File;
  std::string name_;
  std::unique_ptr<File> file_;
};

}  // namespace earthshine::base
