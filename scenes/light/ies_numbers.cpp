// SPDX-License-Identifier: Apache-2.0
#include "scenes/light/ies_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/text/message_text.h"

namespace earthshine::scenes {

using base::Blame;
using base::Error;

double IesNumbers::next(std::string_view what) {
  if (!find()) {
    throw Error(Blame::Input, base::Location{file_, last_line_},
                fmt::format("the file ends where {} is wanted", what),
                "a file of IES LM-63 holds as many numbers as its counts announce",
                "The file is cut off, or a count is wrong");
  }
  return lines_.number(word_);
}

std::size_t IesNumbers::count(std::string_view what, std::size_t low, std::size_t high) {
  const double value = next(what);
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) ||
      value != std::floor(value)) {
    fail(fmt::format("{} is {}", what, in_quotes(word_.text)),
         fmt::format("allowed is a whole number from {} to {}", low, high));
  }
  return static_cast<std::size_t>(value);
}

double IesNumbers::above_zero(std::string_view what) {
  const double value = next(what);
  if (value <= 0.0) {
    fail(fmt::format("{} is {}", what, in_quotes(word_.text)), "allowed are numbers above 0");
  }
  return value;
}

double IesNumbers::not_negative(std::string_view what) {
  const double value = next(what);
  if (value < 0.0) {
    fail(fmt::format("{} is {}", what, in_quotes(word_.text)), "allowed are numbers from 0");
  }
  return value;
}

std::vector<double> IesNumbers::angles(std::size_t count, std::string_view what) {
  std::vector<double> list;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = next(fmt::format("{} {} of {}", what, k + 1, count));
    if (k > 0 && !(angle > list.back())) {
      fail(fmt::format("{} {} of {} is {} after {}", what, k + 1, count, in_quotes(word_.text),
                       list.back()),
           "angles grow from one to the next", "Check the counts of angles too");
    }
    list.push_back(angle);
  }
  return list;
}

std::string IesNumbers::rest() {
  if (!find()) return {};
  if (number_in(word_.text)) {
    fail(fmt::format("{} follows the last candela value", in_quotes(word_.text)),
         "a file of IES LM-63 holds as many numbers as its counts announce",
         "Check the counts of angles");
  }
  // Some programs end a file with a line END.
  while (lower_case(std::string(word_.text)) == "end") {
    if (!find()) return {};
  }
  return fmt::format("{}: {} follows the last candela value and is not read",
                     base::to_string(lines_.where(word_)), in_quotes(word_.text));
}

void IesNumbers::fail(std::string_view found, std::string_view allowed,
                      std::string_view remedy) const {
  throw Error(Blame::Input, lines_.where(word_), found, allowed, remedy);
}

bool IesNumbers::find() {
  while (true) {
    while (rest_.text.empty() && in_line_ < lines_.words().size()) {
      rest_ = lines_.words()[in_line_++];
      last_line_ = rest_.line;
    }
    if (rest_.text.empty()) {
      in_line_ = 0;
      if (!lines_.next()) return false;
      continue;
    }
    const std::size_t comma = std::min(rest_.text.find(','), rest_.text.size());
    word_ = {rest_.text.substr(0, comma), rest_.line, rest_.column};
    const std::size_t used = std::min(comma + 1, rest_.text.size());
    rest_.text.remove_prefix(used);
    rest_.column += static_cast<int>(used);
    if (!word_.text.empty()) return true;
  }
}

}  // namespace earthshine::scenes
