// SPDX-License-Identifier: Apache-2.0
#include "scenes/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenes/mesh.h"
#include "scenes/text/message_text.h"

namespace earthshine::scenes {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

}  // namespace

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::string_view without_end_mark(std::string_view text) {
  constexpr char mark = '\x1a';
  constexpr std::string_view filling{"\x1a\0 \t\r\n", 6};
  const std::size_t last = text.find_last_not_of(filling);
  const std::size_t end = text.find(mark, last == std::string_view::npos ? 0 : last);
  return text.substr(0, end);
}

bool TextLines::next() {
  words_.clear();
  while (words_.empty() && position_ < text_.size()) read_line();
  return !words_.empty();
}

void TextLines::read_line() {
  bool more = true;
  while (more && position_ < text_.size()) {
    more = false;
    ++line_;
    const std::size_t start = position_;
    std::size_t end = text_.find('\n', start);
    position_ = end == std::string_view::npos ? text_.size() : end + 1;
    if (end == std::string_view::npos) end = text_.size();
    while (end > start && blank(text_[end - 1])) --end;
    if (style_ == Style::Wavefront && end > start && text_[end - 1] == '\\') {
      more = true;
      --end;
    }
    std::size_t i = start;
    while (i < end) {
      while (i < end && blank(text_[i])) ++i;
      if (i == end) break;
      if (style_ == Style::Wavefront && text_[i] == '#') {
        more = false;
        break;
      }
      const std::size_t begin = i;
      while (i < end && !blank(text_[i])) ++i;
      const Word word{text_.substr(begin, i - begin), line_, static_cast<int>(begin - start) + 1};
      if (begin <= nul_ && nul_ < i) {
        throw base::Error(base::Blame::Input, where(word), "a NUL byte",
                          "a file of this format is plain text");
      }
      words_.push_back(word);
    }
  }
}

std::string_view TextLines::argument() const {
  if (words_.size() < 2) return {};
  const char* begin = words_[1].text.data();
  const Word& last = words_.back();
  return {begin, static_cast<std::size_t>(last.text.data() + last.text.size() - begin)};
}

double TextLines::number(const Word& word) const {
  const std::string_view text = without_plus(word.text);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole_word = end == text.data() + text.size();
  if (problem == std::errc::result_out_of_range && whole_word &&
      (text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos)) {
    return 0.0;  // too small for the type
  }
  if (problem == std::errc::invalid_argument || !whole_word) {
    throw base::Error(base::Blame::Input, where(word),
                      fmt::format("{} is not a number", in_quotes(word.text)),
                      "a number is wanted here");
  }
  if (problem != std::errc() || !(std::abs(value) <= largest_coordinate)) {
    throw base::Error(base::Blame::Input, where(word),
                      fmt::format("the number {}", in_quotes(word.text)),
                      fmt::format("numbers are finite and at most {}", largest_coordinate));
  }
  return value;
}

double TextLines::number(std::size_t word) const {
  if (word >= words_.size()) {
    throw base::Error(
        base::Blame::Input, where(),
        fmt::format("{} has {} numbers", in_quotes(words_.front().text), words_.size() - 1),
        fmt::format("at least {} are wanted", word));
  }
  return number(words_[word]);
}

Vec3 TextLines::vector() const {
  // A line that is too short reports the required number of words, whichever is requested first.
  if (words_.size() < 4) return Vec3(number(std::size_t{3}));
  return {number(words_[1]), number(words_[2]), number(words_[3])};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> number_in(std::string_view text) {
  text = without_plus(trimmed(text));
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool parse_whole(std::string_view text, std::int64_t& value) {
  text = without_plus(text);
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size() && !text.empty();
}

}  // namespace earthshine::scenes
