// SPDX-License-Identifier: Apache-2.0
// Cosine and sine without branches, so that the compiler vectorises them.
#pragma once

#include <cstdint>

#include "base/units.h"

namespace earthshine::base {

struct Azimuth {
  float cosine, sine;
};

// Cosine and sine of 2 pi u, u in [0, 1). Taylor series about the nearest multiple of pi / 2; error
// below 4e-7.
[[nodiscard]] inline Azimuth azimuth_of(float u) {
  const float quarters = 4.0F * u;
  // Not negative. Where rounding is off, the other quarter is as near.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  const auto quarter = static_cast<std::int32_t>(quarters + 0.5F);
  const float x = (quarters - static_cast<float>(quarter)) * static_cast<float>(0.5 * pi);
  const float x2 = x * x;
  const float sine =
      x *
      (1.0F + x2 * (-1.0F / 6 + x2 * (1.0F / 120 + x2 * (-1.0F / 5040 + x2 * (1.0F / 362880)))));
  const float cosine =
      1.0F + x2 * (-0.5F + x2 * (1.0F / 24 + x2 * (-1.0F / 720 + x2 * (1.0F / 40320))));
  const bool swap = (quarter & 1) != 0;
  const float c = swap ? sine : cosine, s = swap ? cosine : sine;
  return {((quarter + 1) & 2) != 0 ? -c : c, (quarter & 2) != 0 ? -s : s};
}

}  // namespace earthshine::base
