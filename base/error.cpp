// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace earthshine::base {
namespace {

std::string compose(std::string_view where, std::string_view found, std::string_view allowed,
                    std::string_view remedy) {
  std::string text(where);
  if (!text.empty()) text += ": ";
  text += found;
  if (!allowed.empty()) text.append("; ").append(allowed);
  if (!remedy.empty()) text.append(". ").append(remedy);
  // what() ends at the first NUL; text from binary files may contain some.
  for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos;) {
    text.replace(at, 1, "\\x00");
  }
  return text;
}

// Code point of the UTF-8 character of `length` bytes, 2 to 4, at the start of `text`.
unsigned number_of(std::string_view text, std::size_t length) {
  unsigned number = static_cast<unsigned char>(text[0]) & (0xFFU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    number = number << 6U | (static_cast<unsigned char>(text[k]) & 0x3FU);
  }
  return number;
}

struct Span {
  unsigned first, last;
};
// Invisible characters: C1 controls, soft hyphen, Arabic letter mark, direction marks and
// overrides, line separators, zero-width characters, interlinear annotations.
constexpr Span hidden[] = {{0x80, 0x9F},     {0xAD, 0xAD},     {0x61C, 0x61C},
                           {0x180E, 0x180E}, {0x200B, 0x200F}, {0x2028, 0x202E},
                           {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}};

bool is_hidden(unsigned number) {
  return std::any_of(std::begin(hidden), std::end(hidden),
                     [&](const Span& span) { return number >= span.first && number <= span.last; });
}

}  // namespace

std::string to_string(const Location& location) {
  std::string text = location.file;
  if (location.line > 0) text += ":" + std::to_string(location.line);
  if (location.line > 0 && location.column > 0) text += ":" + std::to_string(location.column);
  return text;
}

Error::Error(Blame blame, std::string_view where, std::string_view found, std::string_view allowed,
             std::string_view remedy)
    : Error(blame, Location{std::string(where)}, found, allowed, remedy) {}

Error::Error(Blame blame, const Location& where, std::string_view found, std::string_view allowed,
             std::string_view remedy)
    : std::runtime_error(compose(to_string(where), found, allowed, remedy)),
      blame_(blame),
      parts_(std::make_shared<Parts>(
          Parts{where, std::string(found), std::string(allowed), std::string(remedy)})) {}

std::string system_reason(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

Blame blame_of_target(int error_number) {
  for (const int of_name : {ENAMETOOLONG, ENOTDIR, ENOENT, EEXIST, EISDIR, ELOOP, EINVAL}) {
    if (error_number == of_name) return Blame::Input;
  }
  return Blame::Work;
}

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    if (!follows(1) || !follows(2)) return 0;
    if (first == 0xE0 && byte(1) < 0xA0) return 0;
    if (first == 0xED && byte(1) >= 0xA0) return 0;
    return 3;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if (!follows(1) || !follows(2) || !follows(3)) return 0;
    if (first == 0xF0 && byte(1) < 0x90) return 0;
    if (first == 0xF4 && byte(1) >= 0x90) return 0;
    return 4;
  }
  return 0;
}

std::string escaped(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0 || (byte < 0x20 && kept.find(text[i]) == std::string_view::npos)) {
      result += fmt::format("\\x{:02x}", byte);
    } else if (byte == 0x7F) {
      result += "\\u007f";
    } else if (length > 1 && is_hidden(number_of(text.substr(i), length))) {
      result += fmt::format("\\u{:04x}", number_of(text.substr(i), length));
    } else {
      result += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

}  // namespace earthshine::base
