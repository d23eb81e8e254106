// SPDX-License-Identifier: Apache-2.0
// The numbers of an IES LM-63 file, in whatever lines they stand; commas separate them too.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/text/text_lines.h"

namespace earthshine::scenes {

// Begins with the line after the one that `lines` is at. All throw base::Error (Input) at the
// number's line and column; `what` is its name in the message.
class IesNumbers {
 public:
  // Behind what was read of `lines` last.
  IesNumbers(TextLines& lines, std::string file)
      : lines_(lines), file_(std::move(file)), last_line_(lines.line()) {}

  // Finite.
  [[nodiscard]] double next(std::string_view what);
  void skip(std::string_view what) { static_cast<void>(next(what)); }
  [[nodiscard]] std::size_t count(std::string_view what, std::size_t low, std::size_t high);
  [[nodiscard]] double above_zero(std::string_view what);
  [[nodiscard]] double not_negative(std::string_view what);
  // Each greater than the one before.
  [[nodiscard]] std::vector<double> angles(std::size_t count, std::string_view what);
  // Nothing, or the first word after the last number, which no mark of a file's end explains, and
  // its place. Throws base::Error (Input) where it is a number: then a count is wrong.
  [[nodiscard]] std::string rest();

  // At the last number that was read.
  [[noreturn]] void fail(std::string_view found, std::string_view allowed,
                         std::string_view remedy = {}) const;

 private:
  [[nodiscard]] bool find();

  TextLines& lines_;
  std::string file_;
  std::size_t in_line_ = static_cast<std::size_t>(-1);  // the line it begins after is used up
  int last_line_;
  Word word_, rest_;
};

}  // namespace earthshine::scenes
