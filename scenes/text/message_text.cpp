// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/message_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace earthshine::scenes {

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

std::string printable(std::string_view text, std::size_t longest) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (i >= longest) return result + "...";
    const std::size_t length = utf8_length(text.substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0 || byte < 0x20 || byte == 0x7F) {
      result += fmt::format("\\x{:02x}", byte);
      ++i;
    } else {
      result += text.substr(i, length);
      i += length;
    }
  }
  return result;
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", printable(text, 80)); }

std::string listed(std::span<const std::string> words) {
  constexpr std::size_t most = 20;
  std::string result;
  for (std::size_t i = 0; i < std::min(words.size(), most); ++i) {
    if (i > 0) result += ", ";
    result += printable(words[i], 80);
  }
  if (words.size() > most) result += fmt::format(" and {} more", words.size() - most);
  return result;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > 200) return {};  // the distance costs length times length
  std::string nearest = base::nearest_word(word, candidates);
  // "fov" for "fov_deg" is far by edits but means it.
  for (const std::string& candidate : candidates) {
    if (nearest.empty() && word.size() > 2 && candidate.starts_with(word)) nearest = candidate;
  }
  return nearest.empty() ? std::string() : fmt::format("Did you mean {}?", in_quotes(nearest));
}

}  // namespace earthshine::scenes
