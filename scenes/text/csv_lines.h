// SPDX-License-Identifier: Apache-2.0
// Lines of comma-separated fields, each field with its place. '#' begins a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace earthshine::scenes {

struct CsvField {
  std::string_view text;  // without blanks at its ends
  base::Location where;
};

class CsvLines {
 public:
  // The text must outlive this and its fields. `file` is for messages.
  CsvLines(std::string_view text, std::string file);

  // Goes to the next line that is neither blank nor a comment; false at the end.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::vector<CsvField>& fields() const { return fields_; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  void read_fields(std::string_view line);

  std::string_view text_;
  std::string file_;
  int line_ = 0;
  std::vector<CsvField> fields_;
};

}  // namespace earthshine::scenes
