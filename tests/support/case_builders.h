// SPDX-License-Identifier: Apache-2.0
// Which scene each family of the case library has. Internal to case_library.cpp.
#pragma once

#include <span>

#include "tests/support/case_library.h"

namespace earthshine::tests {

struct CaseBuilder {
  const char* prefix;  // of the names of the family; the first row that fits is taken
  void (*build)(const CaseRecord& record, Case& made);
};

[[nodiscard]] std::span<const CaseBuilder> rectangle_builders();
[[nodiscard]] std::span<const CaseBuilder> round_builders();
[[nodiscard]] std::span<const CaseBuilder> radiosity_builders();

// Strips stand between mirrors this far apart, in widths: images make them infinite. A ray is given
// up after 16 reflections; what two facing strips send beyond a distance of y widths falls as
// 1 / (3 pi y^3), 3e-8 of it after 16 of these lengths.
inline constexpr double strip_length = 10.0;

}  // namespace earthshine::tests
