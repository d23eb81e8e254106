// SPDX-License-Identifier: Apache-2.0
#include "app/json.h"

#include <cmath>

namespace earthshine::app {

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string csv_of(const Json& rows) {
  const auto field = [](const Json& value) -> std::string {
    const bool no_number = value.is_number_float() && !std::isfinite(value.get<double>());
    if (value.is_null() || no_number) return "";
    if (!value.is_string()) return value.dump();
    std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
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
