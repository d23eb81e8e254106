// SPDX-License-Identifier: Apache-2.0
// Writing and reading HDF5. hdf5_writer.cpp and hdf5_reader.cpp are the only users of the
// library.
//
// A file is made and read in memory: what can go wrong with a disk is then the business of
// output_file.h, not of a library that reports a full disk when it closes. In front stands a user
// block, which HDF5's readers pass over, with a seal: the digest of all that follows. A file that
// was changed afterwards never reaches the library, which older versions do not survive.
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

// What a data set's attributes say about it; empty ones are left out.
struct Hdf5Meaning {
  std::string_view unit, meaning;
};

// Names may lead through groups: "ledger/emitted_lm". The same calls give the same bytes. Throws
// base::Error (Work), as out of memory.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  // values: as many as the shape says, the last dimension running fastest.
  template <class T>
  void array(const std::string& name, std::span<const T> values, const Hdf5Shape& shape,
             const Hdf5Meaning& meaning) {
    write(name, values.data(), hdf5_number<T>, shape, meaning);
  }
  void texts(const std::string& name, const std::vector<std::string>& values,
             const Hdf5Meaning& meaning);
  // Of the file as a whole.
  void attribute(const std::string& name, const Hdf5Value& value);

  // The file's bytes, seal included. The writer is spent.
  [[nodiscard]] std::string finish();

 private:
  void write(const std::string& name, const void* values, Hdf5Number number, const Hdf5Shape& shape,
             const Hdf5Meaning& meaning);

  struct File;
  std::unique_ptr<File> file_;
};

// Each call throws base::Error (Input) at the file's name for what is missing or of another type or
// shape; nothing is allocated that the file's own size does not warrant.
class Hdf5Reader {
 public:
  // name: the file's, for messages. Throws base::Error (Input) when the seal is missing or broken.
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

  // Throws base::Error (Input): the file is not what it should be.
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
