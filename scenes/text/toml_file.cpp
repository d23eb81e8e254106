// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "scenes/text/message_text.h"
#include "scenes/text/toml_guard.h"

namespace earthshine::scenes {
namespace {

base::Location place(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

TomlNode convert(const toml::node& node, const std::string& file) {
  TomlNode result{place(node.source(), file), TomlDate{}};
  if (const auto* table = node.as_table()) {
    TomlTable entries;
    for (const auto& [key, value] : *table) {
      entries.push_back({std::string(key.str()), place(key.source(), file), convert(value, file)});
    }
    // toml++ sorts by key; errors are to come in the order in which the user reads the file.
    std::stable_sort(entries.begin(), entries.end(), [](const TomlEntry& a, const TomlEntry& b) {
      return std::pair(a.where.line, a.where.column) < std::pair(b.where.line, b.where.column);
    });
    result.value = std::move(entries);
  } else if (const auto* array = node.as_array()) {
    TomlArray items;
    items.reserve(array->size());
    for (const auto& item : *array) items.push_back(convert(item, file));
    result.value = std::move(items);
  } else if (const auto* text = node.as_string()) {
    result.value = text->get();
  } else if (const auto* whole = node.as_integer()) {
    result.value = whole->get();
  } else if (const auto* number = node.as_floating_point()) {
    result.value = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    result.value = flag->get();
  }
  return result;
}

}  // namespace

const TomlEntry* find_entry(const TomlTable& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const TomlEntry& entry) { return entry.key == key; });
  return found == table.end() ? nullptr : &*found;
}

TomlEntry* find_entry(TomlTable& table, std::string_view key) {
  return const_cast<TomlEntry*>(find_entry(std::as_const(table), key));
}

TomlNode parse_toml(std::string_view text, const std::string& file) {
  guard_toml(text, file);
  try {
    const toml::table root = toml::parse(text, std::string_view(file));
    return convert(root, file);
  } catch (const toml::parse_error& error) {
    throw base::Error(base::Blame::Input, place(error.source(), file),
                      fmt::format("not TOML: {}", printable(error.description(), 200)));
  }
}

std::string describe(const TomlNode& node) {
  struct Describe {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const {
      return fmt::format("the number {}", number);
    }
    std::string operator()(double number) const { return fmt::format("the number {}", number); }
    std::string operator()(const std::string& text) const {
      return fmt::format("the string {}", in_quotes(text));
    }
    std::string operator()(TomlDate) const { return "a date or time"; }
    std::string operator()(const TomlArray& items) const {
      return fmt::format("an array of {}", items.size());
    }
    std::string operator()(const TomlTable&) const { return "a table"; }
  };
  return std::visit(Describe{}, node.value);
}

}  // namespace earthshine::scenes
