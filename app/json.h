// SPDX-License-Identifier: Apache-2.0
// JSON and CSV output.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/units.h"

namespace earthshine::app {

using Json = nlohmann::ordered_json;

[[nodiscard]] inline Json to_json(const Rgb& value) {
  return Json::array({value.r, value.g, value.b});
}
// Indented text with a final newline. Non-finite numbers become null.
[[nodiscard]] std::string dump(const Json& json);
// Compact text: one line per member of an object, or per entry of a list of lists or objects.
[[nodiscard]] std::string dump_lines(const Json& json);
// Digest of the text of dump(), or of a file's bytes.
[[nodiscard]] std::string digest_of(const Json& json);
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& path);
// Maximum nesting in files that are read: the program writes about a dozen levels, and each level
// uses stack.
inline constexpr int deepest_json = 64;
// Contents of a file of at most 1 GiB. Throws base::Error: (Input) for invalid JSON, with the byte,
// or for deeper nesting; `advice` is the remedy.
[[nodiscard]] Json read_json(const std::filesystem::path& path, const std::string& advice);
// Reads a file written by this program. Returns nlohmann's `discarded` value if it is missing or
// broken.
[[nodiscard]] Json json_in(const std::filesystem::path& path);

// A number, or null.
template <class Number>
[[nodiscard]] Json to_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

// A text as a CSV cell (RFC 4180). A text that a spreadsheet would run as a formula (it begins with
// = + - @ and is not a number) gets a leading apostrophe.
[[nodiscard]] std::string csv_cell(std::string text);

// CSV (RFC 4180): `rows` are flat objects with the keys of the first one, which become the header.
// null is an empty field.
[[nodiscard]] std::string csv_of(const Json& rows);

}  // namespace earthshine::app

// In formatted text: a string without quotes, a number by the given format.
template <>
struct fmt::formatter<earthshine::app::Json> {
  constexpr auto parse(fmt::format_parse_context& context) {
    const auto end = std::find(context.begin(), context.end(), '}');
    spec = {context.begin(), end};
    return end;
  }
  fmt::format_context::iterator format(const earthshine::app::Json& value,
                                       fmt::format_context& context) const;

  std::string_view spec;
};
