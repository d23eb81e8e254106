// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/toml_guard.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/escape.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

enum class Inside { Bare, Comment, Basic, Literal, BasicLines, LiteralLines };

// Follows strings and comments just far enough to know where the text stands. A string that the
// line's end cuts off is left to the parser to complain about.
struct Scanner {
  std::string_view text;
  Inside inside = Inside::Bare;
  int dots = 0;

  // The number of bytes that belong together at `i`.
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

  // One or two quotes may stand right before the closing three.
  std::size_t closing_quotes(std::size_t i, char quote) {
    inside = Inside::Bare;
    std::size_t count = 3;
    while (count < 5 && i + count < text.size() && text[i + count] == quote) ++count;
    return count;
  }
};

}  // namespace

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

}  // namespace earthshine::scenes
