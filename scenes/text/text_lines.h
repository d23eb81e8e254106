// SPDX-License-Identifier: Apache-2.0
// Words of a text file, line by line, each with its place; and numbers from words. OBJ, MTL, PLY
// and STL; the fields of CSV files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"

namespace earthshine::scenes {

struct Word {
  std::string_view text;
  int line = 0;
  int column = 0;
};

// Of its letters A to Z.
[[nodiscard]] std::string lower_case(std::string text);

// Without DOS's mark of a file's end, 0x1A, and the zeros and blanks that follow it.
[[nodiscard]] std::string_view without_end_mark(std::string_view text);

class TextLines {
 public:
  // `file` is for messages; the text begins after lines_before lines of it. In OBJ and MTL, '#' at
  // the start of a word opens a comment and a backslash before the line's end joins the next line.
  enum class Style { Plain, Wavefront };
  TextLines(std::string_view text, std::string file, Style style, int lines_before = 0)
      : text_(without_end_mark(text)),
        nul_(text_.find('\0')),
        file_(std::move(file)),
        style_(style),
        line_(lines_before) {}

  // Goes to the next line that holds words; false at the end.
  // Throws base::Error (Input) at a NUL byte: the file is not text.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::vector<Word>& words() const { return words_; }
  // From the second word to the end of the last: a name with spaces.
  [[nodiscard]] std::string_view argument() const;
  [[nodiscard]] int line() const { return words_.empty() ? line_ : words_.front().line; }

  [[nodiscard]] base::Location where() const { return {file_, line(), 0}; }
  [[nodiscard]] base::Location where(const Word& word) const {
    return {file_, word.line, word.column};
  }

  // Finite and at most largest_coordinate in magnitude.
  [[nodiscard]] double number(const Word& word) const;
  [[nodiscard]] double number(std::size_t word) const;  // an error if the line has no such word
  // The first three after the line's keyword.
  [[nodiscard]] Vec3 vector() const;

 private:
  void read_line();

  std::string_view text_;
  std::size_t nul_;  // where the first NUL byte is
  std::string file_;
  Style style_;
  std::size_t position_ = 0;
  int line_;
  std::vector<Word> words_;
};

// Without blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

// A number that fills the text, blanks around it aside; "nan" and "inf" are such.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

// A whole number that fills the text; false otherwise.
[[nodiscard]] bool parse_whole(std::string_view text, std::int64_t& value);

}  // namespace earthshine::scenes
