// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/message_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/suggest.h"

namespace earthshine::scenes {

std::string printable(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return base::escaped(text);
  // Do not cut inside a UTF-8 character; invalid bytes do not matter.
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return base::escaped(text.substr(0, end)) + "...";
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", printable(text, 80)); }

std::string two_digits(double value) {
  if (value < 0.01 && value > 1e-12) {
    return fmt::format("{:.{}f}", value, 1 - static_cast<int>(std::floor(std::log10(value))));
  }
  const std::string text = fmt::format("{:.2g}", value);
  return value < 99.5 ? text : fmt::format("{:.0f}", std::stod(text));
}

std::string percent(double share) { return two_digits(100.0 * share) + " %"; }

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
  const std::string nearest = base::nearest_word(word, candidates);
  return nearest.empty() ? std::string() : fmt::format("Did you mean {}?", in_quotes(nearest));
}

}  // namespace earthshine::scenes
