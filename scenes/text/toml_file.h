// SPDX-License-Identifier: Apache-2.0
// Parses TOML text to a plain tree in which every key and value has its place. toml_file.cpp is the
// only user of toml++; it rejects texts that toml++ cannot handle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"

namespace earthshine::scenes {

struct TomlNode;
struct TomlEntry;
struct TomlDate {
  std::string text;  // ISO 8601
};
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

// Null if the table lacks the key.
[[nodiscard]] const TomlEntry* find_entry(const TomlTable& table, std::string_view key);
[[nodiscard]] TomlEntry* find_entry(TomlTable& table, std::string_view key);

// The root table. Throws base::Error (Input) at file:line:column for text that is not TOML.
[[nodiscard]] TomlNode parse_toml(std::string_view text, const std::string& file);

// The root table of a file. Throws as parse_toml, and if the path is not a regular file or the file
// is of another kind.
[[nodiscard]] TomlNode read_toml(const std::filesystem::path& path);

// A finite number.
[[nodiscard]] std::optional<double> number_of(const TomlNode& node);
// A number, or the numbers of a list; empty for anything else.
[[nodiscard]] std::vector<double> numbers_of(const TomlNode& node);

// "the string "abc"", "the number 3", "a table": for messages.
[[nodiscard]] std::string describe(const TomlNode& node);

// Guards against input that toml++ cannot handle: some characters outside strings cause undefined
// behaviour, and keys with many dots overflow the stack (both measured on 3.3 and 3.4).

inline constexpr std::size_t max_toml_bytes = std::size_t{1} << 20;
inline constexpr std::size_t max_toml_line_bytes = std::size_t{8} << 10;
inline constexpr int max_toml_dots = 16;  // in one key

// Throws base::Error (Input) unless the text is at most 1 MiB of UTF-8 in lines of at most 8 KiB,
// free of NUL bytes, ASCII outside strings and comments, and its keys have at most 16 dots.
void guard_toml(std::string_view text, const std::string& file);

}  // namespace earthshine::scenes
