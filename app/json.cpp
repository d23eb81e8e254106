// SPDX-License-Identifier: Apache-2.0
#include "app/json.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "base/input/input_file.h"
#include "base/numbers/digest.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;

constexpr std::size_t largest_json_bytes = std::size_t{1} << 30;

}  // namespace

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

std::string lines_of(const Json& json, const std::string& indent) {
  const bool has_lines =
      json.is_object() || (json.is_array() && !json.empty() && json.front().is_structured());
  if (!has_lines || json.empty()) return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string inner = indent + "  ";
  std::string text;
  for (const auto& [key, value] : json.items()) {
    text += (text.empty() ? "\n" : ",\n") + inner;
    text += json.is_object() ? Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) +
                                   ": " + lines_of(value, inner)
                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return (json.is_object() ? "{" : "[") + text + "\n" + indent + (json.is_object() ? "}" : "]");
}

}  // namespace

std::string dump_lines(const Json& json) { return lines_of(json, "") + "\n"; }

std::string digest_of(const Json& json) {
  base::Digest digest;
  digest.add(std::string_view(dump(json)));
  return digest.text();
}

std::string digest_of_file(const std::filesystem::path& path) {
  base::Digest digest;
  digest.add(std::string_view(
      base::read_input_file(path, std::numeric_limits<std::size_t>::max(), {path.string()})));
  return digest.text();
}

Json read_json(const std::filesystem::path& path, const std::string& advice) {
  const std::string name = path.string();
  const std::string text = base::read_input_file(path, largest_json_bytes, {name});
  const auto check_depth = [&](int around, Json::parse_event_t event, const Json&) {
    const bool begins =
        event == Json::parse_event_t::array_start || event == Json::parse_event_t::object_start;
    if (begins && around >= deepest_json) {
      throw Error(Blame::Input, name, "has lists and objects too deep within one another",
                  fmt::format("at most {} levels", deepest_json), advice);
    }
    return true;
  };
  try {
    return Json::parse(text, check_depth);
  } catch (const Json::parse_error& error) {
    throw Error(Blame::Input, name,
                fmt::format("is not JSON: at byte {} it goes wrong", error.byte), {}, advice);
  } catch (const Json::exception&) {
    throw Error(Blame::Input, name, "holds a number that is too large", {}, advice);
  }
}

Json json_in(const std::filesystem::path& path) {
  try {
    return read_json(path, "");
  } catch (const Error&) {
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

fmt::format_context::iterator fmt::formatter<earthshine::app::Json>::format(
    const earthshine::app::Json& value, fmt::format_context& context) const {
  const std::string form = fmt::format("{{:{}}}", spec);
  const auto write = [&](const auto& plain) {
    return fmt::vformat_to(context.out(), form, fmt::make_format_args(plain));
  };
  if (value.is_string()) return write(value.get_ref<const std::string&>());
  const bool as_real = form.find_first_of("efg") != std::string::npos;
  return as_real || value.is_number_float() ? write(value.get<double>())
                                            : write(value.get<std::int64_t>());
}
