// SPDX-License-Identifier: Apache-2.0
// Scene builders of the families of the case library. Internal to case_library.cpp.
#pragma once

#include <span>

#include "tests/support/case_library.h"

namespace earthshine::tests {

struct CaseBuilder {
  const char* prefix;  // of the names in the family; the first matching row is used
  void (*build)(const CaseRecord& record, Case& made);
};

[[nodiscard]] std::span<const CaseBuilder> rectangle_builders();
[[nodiscard]] std::span<const CaseBuilder> round_builders();
[[nodiscard]] std::span<const CaseBuilder> radiosity_builders();

// Strips between mirrors at this distance, in widths; the mirror images make them infinite. A ray
// ends after 16 reflections. The light that facing strips exchange beyond a distance of y widths
// falls as 1 / (3 pi y^3): 3e-8 of it after 16 of these lengths.
inline constexpr double strip_length = 10.0;

}  // namespace earthshine::tests
