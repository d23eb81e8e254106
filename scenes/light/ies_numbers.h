// SPDX-License-Identifier: Apache-2.0
// The numbers of an IES LM-63 file, independent of lines; commas separate them too.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/text/text_lines.h"

namespace earthshine::scenes {

// Begins with the line after the current line of `lines`. All functions throw base::Error (Input)
// at the number's line and column; `what` is its name in the message.
class IesNumbers {
 public:
  // Starts after the last line read from `lines`.
  IesNumbers(TextLines& lines, std::string file)
      : lines_(lines), file_(std::move(file)), last_line_(lines.line()) {}

  // The next number, finite.
  [[nodiscard]] double next(std::string_view what);
  void skip(std::string_view what) { static_cast<void>(next(what)); }
  [[nodiscard]] std::size_t count(std::string_view what, std::size_t low, std::size_t high);
  [[nodiscard]] double above_zero(std::string_view what);
  [[nodiscard]] double not_negative(std::string_view what);
  // Strictly increasing angles.
  [[nodiscard]] std::vector<double> angles(std::size_t count, std::string_view what);
  // The first word after the last number, with its place, unless it is an end-of-file mark; else
  // empty. Throws base::Error (Input) if it is a number: then a count is wrong.
  [[nodiscard]] std::string rest();

  // Error at the last number read.
  [[noreturn]] void fail(std::string_view found, std::string_view allowed,
                         std::string_view remedy = {}) const;

 private:
  [[nodiscard]] bool find();

  TextLines& lines_;
  std::string file_;
  std::size_t in_line_ = static_cast<std::size_t>(-1);  // initially past the end of the line
  int last_line_;
  Word word_, rest_;
};

}  // namespace earthshine::scenes
