// SPDX-License-Identifier: Apache-2.0
// TOML text to a plain tree whose every key and value knows its place. toml_file.cpp is the only
// user of toml++, which is kept from texts that it cannot digest (toml_guard.h).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"

namespace earthshine::scenes {

struct TomlNode;
struct TomlEntry;
struct TomlDate {};  // dates and times: TOML has them, scenes do not
using TomlArray = std::vector<TomlNode>;
using TomlTable = std::vector<TomlEntry>;  // in the order of the file

struct TomlNode {
  base::Location where;
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> value;
};

struct TomlEntry {
  std::string key;
  base::Location where;
  TomlNode node;
};

// Null when the table has no such key.
[[nodiscard]] const TomlEntry* find_entry(const TomlTable& table, std::string_view key);
[[nodiscard]] TomlEntry* find_entry(TomlTable& table, std::string_view key);

// The root table. Throws base::Error (Input) at file:line:column for text that is not TOML.
[[nodiscard]] TomlNode parse_toml(std::string_view text, const std::string& file);

// "the string "abc"", "the number 3", "a table": for messages.
[[nodiscard]] std::string describe(const TomlNode& node);

}  // namespace earthshine::scenes
