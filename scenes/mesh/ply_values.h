// SPDX-License-Identifier: Apache-2.0
// Sequential reader of the numbers after a PLY header, in any of the three encodings.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenes/text/text_lines.h"

namespace earthshine::scenes {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

[[nodiscard]] std::optional<PlyType> ply_type(std::string_view word);
[[nodiscard]] std::optional<PlyEncoding> ply_encoding(std::string_view word);

class PlyValues {
 public:
  // `bytes` follow the header, which took header_lines lines.
  PlyValues(std::string_view bytes, std::string file, PlyEncoding encoding, int header_lines)
      : bytes_(bytes),
        file_(std::move(file)),
        encoding_(encoding),
        lines_(bytes, file_, TextLines::Style::Plain, header_lines) {}

  // Throws base::Error (Input) at the end of the file and, in ascii, for words that are not
  // numbers.
  double next(PlyType type);

  // Upper limit of the number of remaining values.
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - position_; }
  // Whether a word follows; in binary, whether bytes other than zeros and blanks follow.
  [[nodiscard]] bool has_more();
  // Ascii: the line of the last number; binary: 0.
  [[nodiscard]] std::uint32_t line() const;
  [[nodiscard]] base::Location where() const;

 private:
  double next_word();

  std::string_view bytes_;
  std::string file_;
  PlyEncoding encoding_;
  TextLines lines_;
  std::size_t position_ = 0;  // binary
  std::size_t word_ = 0;      // ascii: the next word of the line
};

}  // namespace earthshine::scenes
