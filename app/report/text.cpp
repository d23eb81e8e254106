// SPDX-License-Identifier: Apache-2.0
#include "app/report/text.h"

#include <fmt/format.h>

#include <cmath>

namespace earthshine::app {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

// Bytes of the UTF-8 character at the start of `text`; 0 where there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80) return 0;
  }
  // Longer than needed, a surrogate, or beyond the last character.
  if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F)) return 0;
  if ((first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F)) return 0;
  return length;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string html;
  html.reserve(text.size() + text.size() / 8);
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const auto code = static_cast<unsigned char>(c);
    const std::size_t length = character_length(text.substr(at));
    if (length == 0 || code == 0x7F || (code < 0x20 && c != '\t' && c != '\n')) {
      html += replacement;
    } else if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else if (c == '>') {
      html += "&gt;";
    } else if (c == '"') {
      html += "&quot;";
    } else if (c == '\'') {
      html += "&#39;";
    } else {
      html += text.substr(at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return html;
}

std::string island(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&') {
      text += fmt::format("\\u{:04x}", c);
    } else {
      text += c;
    }
  }
  return text;
}

std::string base64(std::string_view bytes) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word <<= 8U;
      if (at + k < bytes.size()) word |= static_cast<unsigned char>(bytes[at + k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += at + k <= bytes.size() ? digits[(word >> (18 - 6 * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string figure(const Number& value, Form form) {
  if (!value || !std::isfinite(*value)) return dash;
  const double x = form == Form::Percent ? 100.0 * *value : *value;
  if (form == Form::Count) return fmt::format("{:.0f}", x);
  if (form == Form::Chance) {
    if (x > 0.995 && x < 1.0) return "&gt;0.99";
    if (x > 0.0 && x < 0.005) return "&lt;0.01";
    return fmt::format("{:.2f}", x);
  }
  const double size = std::fabs(x);
  return size >= 999.5 && size < 1e7 ? fmt::format("{:.0f}", x) : fmt::format("{:.3g}", x);
}

std::string shares_text(const std::vector<GroupShare>& shares, Form form) {
  std::string text;
  for (const GroupShare& share : shares) {
    if (!text.empty()) text += ", ";
    text += escaped(share.group) + " " + figure(share.value, form);
    if (form == Form::Percent && share.value) text += " %";
  }
  return text.empty() ? dash : text;
}

std::string place_of(const ConditionEntry& condition) {
  if (!condition.position_deg) return condition.name.empty() ? condition.id : condition.name;
  return fmt::format("{:.6g}°", *condition.position_deg);
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace earthshine::app
