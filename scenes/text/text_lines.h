// SPDX-License-Identifier: Apache-2.0
// Splits a text file into words with their places, line by line, and parses numbers. Used for OBJ,
// MTL, PLY and STL, and for the fields of CSV files.
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

// Converts A to Z only.
[[nodiscard]] std::string lower_case(std::string text);

// Removes the DOS end-of-file mark, 0x1A, with the zeros and blanks that follow it.
[[nodiscard]] std::string_view without_end_mark(std::string_view text);

class TextLines {
 public:
  // `file` is for messages; the text begins after its first lines_before lines. In OBJ and MTL, '#'
  // at the start of a word begins a comment, and a backslash at the end of a line joins the next
  // line.
  enum class Style { Plain, Wavefront };
  TextLines(std::string_view text, std::string file, Style style, int lines_before = 0)
      : text_(without_end_mark(text)),
        nul_(text_.find('\0')),
        file_(std::move(file)),
        style_(style),
        line_(lines_before) {}

  // Advances to the next line with words; false at the end. Throws base::Error (Input) at a NUL
  // byte: the file is not text.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::vector<Word>& words() const { return words_; }
  // From the second word to the end of the last word: a name with spaces.
  [[nodiscard]] std::string_view argument() const;
  [[nodiscard]] int line() const { return words_.empty() ? line_ : words_.front().line; }

  [[nodiscard]] base::Location where() const { return {file_, line(), 0}; }
  [[nodiscard]] base::Location where(const Word& word) const {
    return {file_, word.line, word.column};
  }

  // Finite and at most largest_coordinate in magnitude.
  [[nodiscard]] double number(const Word& word) const;
  [[nodiscard]] double number(std::size_t word) const;  // an error if the line has no such word
  // The first three words after the line's keyword.
  [[nodiscard]] Vec3 vector() const;

 private:
  void read_line();

  std::string_view text_;
  std::size_t nul_;  // position of the first NUL byte
  std::string file_;
  Style style_;
  std::size_t position_ = 0;
  int line_;
  std::vector<Word> words_;
};

// Without leading and trailing blanks.
[[nodiscard]] std::string_view trimmed(std::string_view text);

// A number that fills the text except for blanks around it; accepts "nan" and "inf".
[[nodiscard]] std::optional<double> number_in(std::string_view text);

// An integer that fills the text; false otherwise.
[[nodiscard]] bool parse_whole(std::string_view text, std::int64_t& value);

}  // namespace earthshine::scenes
