// SPDX-License-Identifier: Apache-2.0
// What a setting is. Each settings struct has one list of its fields (visit_fields); the scene
// reader, the program's listing and the table in docs/cctv.md all walk that list.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace earthshine::degrade {

// Numbers allowed, both ends included. Not used for words and switches.
struct Limits {
  double least = 0.0;
  double most = 0.0;
};
inline constexpr Limits no_limits{};

// The word of an enumerator; words_of(E) is overloaded beside each enum, in the order of its
// enumerators.
template <class Enum>
[[nodiscard]] constexpr std::string_view word_of(Enum value) {
  return words_of(value)[static_cast<std::size_t>(value)];
}

}  // namespace earthshine::degrade
