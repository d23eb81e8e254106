// SPDX-License-Identifier: Apache-2.0
// Text, numbers and bytes for the report's HTML.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/report/data.h"

namespace earthshine::app {

// Escapes a text for HTML, between tags and inside quotes. Invalid UTF-8 and control characters
// become U+FFFD. Text that may be written from right to left, or changes the direction, is enclosed
// in U+2068 and U+2069 (UAX #9), so that the following text keeps its direction.
[[nodiscard]] std::string escaped(std::string_view text);

// JSON for a <script type="application/json">: it cannot contain the end of the element.
[[nodiscard]] std::string island(const Json& json);

[[nodiscard]] std::string base64(std::string_view bytes);

// Shown for missing values.
inline constexpr const char* dash = "–";

// Three significant digits, or the dash. Chance: two decimals, 0 or 1 only if exact.
[[nodiscard]] std::string figure(const Number& value, Form form = Form::Plain);

// "sun 40 %, bay-lamps 60 %" or "earth 120, bay-lamps 3.1" (of `unit`), escaped.
[[nodiscard]] std::string shares_text(const std::vector<GroupShare>& shares, Form form);

// The position of a condition: "40°", or its name if it has none.
[[nodiscard]] std::string place_of(const ConditionEntry& condition);

// "1 result", "2 results".
[[nodiscard]] std::string counted(std::size_t count, const std::string& one,
                                  const std::string& many);

}  // namespace earthshine::app
