// SPDX-License-Identifier: Apache-2.0
// JSON and CSV as the program writes them.
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
// Indented text with a final newline. Numbers that are not finite become null.
[[nodiscard]] std::string dump(const Json& json);
// Text of fewer lines: one for each member of an object, of a list of lists or objects one for each
// entry.
[[nodiscard]] std::string dump_lines(const Json& json);
// Of the text of dump(); of a file's bytes.
[[nodiscard]] std::string digest_of(const Json& json);
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& path);
// Lists and objects within one another in a file that is read: what the program writes has a
// dozen, and each level takes some of the stack.
inline constexpr int deepest_json = 64;
// The content of a file of at most 1 GiB. Throws base::Error: (Input) where it is no JSON, with the
// byte, or is nested deeper; `advice` says what to do.
[[nodiscard]] Json read_json(const std::filesystem::path& path, const std::string& advice);
// What the program wrote into a file; discarded (nlohmann) where there is none or it is broken.
[[nodiscard]] Json json_in(const std::filesystem::path& path);

// A number, or null.
template <class Number>
[[nodiscard]] Json to_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

// A text as a cell of comma-separated values (RFC 4180). One that a spreadsheet would run as a
// formula, as it begins with = + - @ and is no number, gets an apostrophe before it.
[[nodiscard]] std::string csv_cell(std::string text);

// Comma-separated values (RFC 4180): `rows` are flat objects with the keys of the first, which
// become the header. null is an empty field.
[[nodiscard]] std::string csv_of(const Json& rows);

}  // namespace earthshine::app

// In a text: a string without quotes, a number by the given format.
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
