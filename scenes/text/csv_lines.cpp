// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/csv_lines.h"

#include "scenes/text/text_lines.h"

namespace earthshine::scenes {

CsvLines::CsvLines(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

bool CsvLines::next() {
  while (!text_.empty()) {
    ++line_;
    const std::size_t end = text_.find('\n');
    read_fields(text_.substr(0, end));
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (!fields_.empty()) return true;
  }
  return false;
}

void CsvLines::read_fields(std::string_view line) {
  const char* const start = line.data();
  line = line.substr(0, line.find('#'));
  fields_.clear();
  if (trimmed(line).empty()) return;
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string_view text = trimmed(line.substr(0, comma));
    const char* const at = text.empty() ? line.data() : text.data();
    fields_.push_back({text, {file_, line_, static_cast<int>(at - start) + 1}});
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace earthshine::scenes
