// SPDX-License-Identifier: Apache-2.0
// Texts, figures and bytes as the report's HTML has them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/report/data.h"

namespace earthshine::app {

// Any text as HTML that shows it and does nothing else, between tags and inside quotes. What is no
// UTF-8, and control characters, become U+FFFD. Text that may be written from right to left, or
// that turns the direction of writing, stands between U+2068 and U+2069 (UAX #9): what follows keeps
// its own direction.
[[nodiscard]] std::string escaped(std::string_view text);

// JSON for a <script type="application/json">: nothing in it can end the element.
[[nodiscard]] std::string island(const Json& json);

[[nodiscard]] std::string base64(std::string_view bytes);

// What stands for a value that does not exist.
inline constexpr const char* dash = "–";

// Three significant digits, or the dash. Chance: two decimals, and never 1 or 0 unless it is.
[[nodiscard]] std::string figure(const Number& value, Form form = Form::Plain);

// "sun 40 %, bay-lamps 60 %" or "earth 120, bay-lamps 3.1" (of `unit`), escaped.
[[nodiscard]] std::string shares_text(const std::vector<GroupShare>& shares, Form form);

// The columns of a condition's place: "40°", or its name where it has none.
[[nodiscard]] std::string place_of(const ConditionEntry& condition);

// "1 result", "2 results".
[[nodiscard]] std::string counted(std::size_t count, const std::string& one,
                                  const std::string& many);

}  // namespace earthshine::app
