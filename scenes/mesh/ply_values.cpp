// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh/ply_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace earthshine::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "the byte order below assumes it");

constexpr std::pair<std::string_view, PlyType> types[] = {
    {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
    {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
    {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
    {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
    {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
    {"float64", PlyType::Float64}};

constexpr std::pair<std::string_view, PlyEncoding> encodings[] = {
    {"ascii", PlyEncoding::Ascii},
    {"binary_little_endian", PlyEncoding::LittleEndian},
    {"binary_big_endian", PlyEncoding::BigEndian}};

template <class T>
double as_double(const std::array<char, 8>& raw) {
  T value;
  std::memcpy(&value, raw.data(), sizeof value);
  return static_cast<double>(value);
}

struct Binary {
  std::size_t size;
  double (*value)(const std::array<char, 8>& raw);
};
// In PlyType's order.
constexpr Binary binary[] = {{1, as_double<std::int8_t>},  {1, as_double<std::uint8_t>},
                             {2, as_double<std::int16_t>}, {2, as_double<std::uint16_t>},
                             {4, as_double<std::int32_t>}, {4, as_double<std::uint32_t>},
                             {4, as_double<float>},        {8, as_double<double>}};

}  // namespace

std::optional<PlyType> ply_type(std::string_view word) {
  for (const auto& [name, type] : types) {
    if (name == word) return type;
  }
  return std::nullopt;
}

std::optional<PlyEncoding> ply_encoding(std::string_view word) {
  for (const auto& [name, encoding] : encodings) {
    if (name == word) return encoding;
  }
  return std::nullopt;
}

double PlyValues::next(PlyType type) {
  if (encoding_ == PlyEncoding::Ascii) return next_word();
  const auto [size, value] = binary[static_cast<std::size_t>(type)];
  if (bytes_left() < size) {
    throw base::Error(base::Blame::Input, where(), "the file ends before its last number",
                      "the header announces more", "The file is cut off");
  }
  std::array<char, 8> raw{};
  std::memcpy(raw.data(), bytes_.data() + position_, size);
  position_ += size;
  if (encoding_ == PlyEncoding::BigEndian) {
    std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return value(raw);
}

bool PlyValues::has_more() {
  if (encoding_ == PlyEncoding::Ascii) {
    if (word_ < lines_.words().size()) return true;
    word_ = 0;
    return lines_.next();
  }
  constexpr std::string_view padding{"\0 \r\n\t", 5};
  return bytes_.find_first_not_of(padding, position_) != std::string_view::npos;
}

double PlyValues::next_word() {
  if (!has_more()) {
    throw base::Error(base::Blame::Input, where(), "the file ends before its last number",
                      "the header announces more", "The file is cut off");
  }
  return lines_.number(lines_.words()[word_++]);
}

std::uint32_t PlyValues::line() const {
  if (encoding_ != PlyEncoding::Ascii) return 0;
  return static_cast<std::uint32_t>(lines_.line());
}

base::Location PlyValues::where() const {
  if (encoding_ == PlyEncoding::Ascii) return {file_, static_cast<int>(line()), 0};
  return {fmt::format("{}, byte {} of the data", file_, position_)};
}

}  // namespace earthshine::scenes
