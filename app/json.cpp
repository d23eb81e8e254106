// SPDX-License-Identifier: Apache-2.0
#include "app/json.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/input/input_file.h"
#include "base/numbers/digest.h"

namespace earthshine::app {
namespace {

constexpr std::size_t largest_json_bytes = std::size_t{1} << 30;

}  // namespace

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string digest_of(const Json& json) {
  base::Digest digest;
  digest.add(std::string_view(dump(json)));
  return digest.text();
}

Json json_in(const std::filesystem::path& path) {
  try {
    return Json::parse(base::read_input_file(path, largest_json_bytes, {path.string()}), nullptr,
                       false);
  } catch (const base::Error&) {
    return Json::value_t::discarded;
  }
}

std::string csv_cell(std::string text) {
  constexpr std::string_view runs = "=+-@\t\r";
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
  const bool is_number = std::from_chars(first, end, number).ptr == end;
  if (!text.empty() && runs.find(text[0]) != std::string_view::npos && !is_number) {
    text.insert(0, 1, '\'');
  }
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_of(const Json& rows) {
  const auto field = [](const Json& value) -> std::string {
    const bool no_number = value.is_number_float() && !std::isfinite(value.get<double>());
    if (value.is_null() || no_number) return "";
    if (!value.is_string()) return value.dump();
    return csv_cell(value.get<std::string>());
  };
  std::string text;
  if (rows.empty()) return text;
  for (const auto& [key, value] : rows.front().items()) text += (text.empty() ? "" : ",") + key;
  text += "\n";
  for (const Json& row : rows) {
    std::string line;
    bool first = true;
    for (const auto& [key, value] : row.items()) {
      line += (first ? "" : ",") + field(value);
      first = false;
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace earthshine::app
