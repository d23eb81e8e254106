// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/input/input_file.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

base::Location place(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

template <class Date>
std::string text_of(const Date& date) {
  std::ostringstream text;
  text << date;
  return text.str();
}

TomlNode convert(const toml::node& node, const std::string& file) {
  TomlNode result{place(node.source(), file), TomlDate{}};
  if (const auto* table = node.as_table()) {
    TomlTable entries;
    for (const auto& [key, value] : *table) {
      entries.push_back({std::string(key.str()), place(key.source(), file), convert(value, file)});
    }
    // toml++ sorts by key; errors should be in the order of the file.
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
  } else if (const auto* date_time = node.as_date_time()) {
    result.value = TomlDate{text_of(date_time->get())};
  } else if (const auto* date = node.as_date()) {
    result.value = TomlDate{text_of(date->get())};
  } else if (const auto* time = node.as_time()) {
    result.value = TomlDate{text_of(time->get())};
  }
  return result;
}

using base::Blame;
using base::Error;

// First bytes of a picture, a solution or a mesh given instead of a scene.
constexpr std::pair<std::string_view, std::string_view> other_kinds[] = {
    {"\x76\x2f\x31\x01", "an OpenEXR picture"},
    {"\x89PNG", "a PNG picture"},
    {"\xff\xd8\xff", "a JPEG picture"},
    {"\x89HDF", "an HDF5 file, such as solve -o writes"},
    {"glTF", "a binary glTF mesh"}};

enum class Inside { Bare, Comment, Basic, Literal, BasicLines, LiteralLines };

// Tracks strings and comments to locate bare text. The parser reports unterminated strings.
struct Scanner {
  std::string_view text;
  Inside inside = Inside::Bare;
  int dots = 0;

  // Number of bytes that form one unit at `i`.
  std::size_t step(std::size_t i) {
    const char c = text[i];
    const bool triple = text.substr(i, 3) == "\"\"\"" || text.substr(i, 3) == "'''";
    switch (inside) {
      case Inside::Bare:
        if (c == '#') inside = Inside::Comment;
        if (c == '"' || c == '\'') {
          const bool basic = c == '"';
          if (triple) {
            inside = basic ? Inside::BasicLines : Inside::LiteralLines;
            return 3;
          }
          inside = basic ? Inside::Basic : Inside::Literal;
        }
        if (c == '.') ++dots;
        if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n')
          dots = 0;
        return 1;
      case Inside::Comment:
        if (c == '\n') leave();
        return 1;
      case Inside::Basic:
        if (c == '\\' && i + 1 < text.size() && (text[i + 1] == '"' || text[i + 1] == '\\'))
          return 2;
        if (c == '"') inside = Inside::Bare;
        if (c == '\n') leave();
        return 1;
      case Inside::Literal:
        if (c == '\'') inside = Inside::Bare;
        if (c == '\n') leave();
        return 1;
      case Inside::BasicLines:
        if (c == '\\' && i + 1 < text.size() && (text[i + 1] == '"' || text[i + 1] == '\\'))
          return 2;
        return c == '"' && triple ? closing_quotes(i, '"') : 1;
      case Inside::LiteralLines:
        return c == '\'' && triple ? closing_quotes(i, '\'') : 1;
    }
    return 1;
  }

  void leave() {
    inside = Inside::Bare;
    dots = 0;
  }

  // One or two quotes may directly precede the closing three.
  std::size_t closing_quotes(std::size_t i, char quote) {
    inside = Inside::Bare;
    std::size_t count = 3;
    while (count < 5 && i + count < text.size() && text[i + count] == quote) ++count;
    return count;
  }
};

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

TomlNode read_toml(const std::filesystem::path& path) {
  const base::Location where{path.string()};
  base::check_input_file(path, where);
  std::string start(8, '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), 8);
  for (const auto& [magic, kind] : other_kinds) {
    if (!start.starts_with(magic)) continue;
    throw Error(Blame::Input, where, fmt::format("is {}", kind),
                "a TOML file is wanted here: plain text");
  }
  return parse_toml(base::read_input_file(path, max_toml_bytes, where), path.string());
}

std::string describe(const TomlNode& node) {
  struct Describe {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const {
      return fmt::format("the number {}", number);
    }
    std::string operator()(double number) const {
      const std::string text = fmt::format("{}", number);
      const bool whole = text.find_first_of(".en") == std::string::npos;
      return "the number " + text + (whole ? ".0" : "");
    }
    std::string operator()(const std::string& text) const {
      return fmt::format("the string {}", in_quotes(text));
    }
    std::string operator()(const TomlDate&) const { return "a date or time"; }
    std::string operator()(const TomlArray& items) const {
      std::string text = fmt::format("an array of {}", items.size());
      const bool few = items.size() <= 4 && std::ranges::none_of(items, [](const TomlNode& item) {
                         return std::holds_alternative<TomlArray>(item.value);
                       });
      for (std::size_t k = 0; few && k < items.size(); ++k) {
        text += (k == 0 ? ": " : ", ") + describe(items[k]);
      }
      return text;
    }
    std::string operator()(const TomlTable&) const { return "a table"; }
  };
  return std::visit(Describe{}, node.value);
}

void guard_toml(std::string_view text, const std::string& file) {
  if (text.size() > max_toml_bytes) {
    throw Error(Blame::Input, base::Location{file},
                fmt::format("the text has {} bytes", text.size()),
                fmt::format("at most {} are read", max_toml_bytes), "Put geometry into mesh files");
  }
  Scanner scanner{text};
  int line = 1;
  std::size_t line_start = 0;
  int column = 1;
  std::size_t i =
      text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;  // a byte order mark may open the file
  while (i < text.size()) {
    const base::Location here{file, line, column};
    const auto byte = static_cast<unsigned char>(text[i]);
    if (i - line_start > max_toml_line_bytes) {
      throw Error(Blame::Input, base::Location{file, line, 0}, "the line is too long",
                  fmt::format("a line has at most {} bytes", max_toml_line_bytes), "Break it");
    }
    if (byte == 0) {
      throw Error(Blame::Input, here, "a NUL byte", "a TOML file is plain text");
    }
    std::size_t length = 1;
    if (byte >= 0x80) {
      length = base::utf8_length(text.substr(i));
      if (length == 0) {
        throw Error(Blame::Input, here, fmt::format("the byte 0x{:02x} is not UTF-8", byte),
                    "a TOML file is UTF-8 text", "Save it as UTF-8");
      }
      if (scanner.inside == Inside::Bare) {
        throw Error(
            Blame::Input, here,
            fmt::format("the character \"{}\" outside a string", text.substr(i, length)),
            "keys and values are plain ASCII; other characters stand in strings and comments",
            "Put it in quotes");
      }
      ++column;
    } else {
      length = scanner.step(i);
      column += static_cast<int>(length);
      if (text[i] == '\n') {
        ++line;
        column = 1;
        line_start = i + 1;
      }
    }
    if (scanner.dots > max_toml_dots) {
      throw Error(Blame::Input, here, "a key of too many parts",
                  fmt::format("a dotted key has at most {} dots", max_toml_dots));
    }
    i += length;
  }
}

std::optional<double> number_of(const TomlNode& node) {
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) {
    return static_cast<double>(*whole);
  }
  const auto* number = std::get_if<double>(&node.value);
  return number != nullptr && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

std::vector<double> numbers_of(const TomlNode& node) {
  if (const auto number = number_of(node)) return {*number};
  std::vector<double> numbers;
  if (const auto* items = std::get_if<TomlArray>(&node.value)) {
    for (const TomlNode& item : *items) {
      const auto number = number_of(item);
      if (!number) return {};
      numbers.push_back(*number);
    }
  }
  return numbers;
}

}  // namespace earthshine::scenes
