// SPDX-License-Identifier: Apache-2.0
// Description of settings. Each settings struct lists its fields once (visit_fields); the scene
// reader, the program's listing and the table in docs/cctv.md iterate over this list.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace earthshine::degrade {

// Allowed numbers, both ends included. Unused for words and switches.
struct Limits {
  double least = 0.0;
  double most = 0.0;
};
inline constexpr Limits no_limits{};

// The word of an enumerator. words_of(E), defined beside each enum, lists the words in the order of
// its enumerators.
template <class Enum>
[[nodiscard]] constexpr std::string_view word_of(Enum value) {
  return words_of(value)[static_cast<std::size_t>(value)];
}

}  // namespace earthshine::degrade
