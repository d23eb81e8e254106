// SPDX-License-Identifier: Apache-2.0
// Formats text from users or files for one-line messages.
#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace earthshine::scenes {

// Escaped as by base::escaped(), and cut after `longest` bytes.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest);

// Printable text in quotes, cut at 80 bytes.
[[nodiscard]] std::string in_quotes(std::string_view text);

// Two significant digits without an exponent: 0.0013, 2000. value: 0 or more.
[[nodiscard]] std::string two_digits(double value);

// A share with two digits: "0.0013 %", "130 %".
[[nodiscard]] std::string percent(double share);

// "a, b, c": at most 20 words, then "and N more".
[[nodiscard]] std::string listed(std::span<const std::string> words);

// "Did you mean "x"?", or "" without a similar candidate.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       std::span<const std::string> candidates);
// For any range of strings.
template <class Words>
[[nodiscard]] std::string did_you_mean(std::string_view word, const Words& candidates) {
  const std::vector<std::string> words(std::begin(candidates), std::end(candidates));
  return did_you_mean(word, std::span<const std::string>(words));
}

}  // namespace earthshine::scenes
