// SPDX-License-Identifier: Apache-2.0
// Signal and noise of the details of one level (share.h).
#pragma once

#include <vector>

#include "raytrace/share/share.h"

namespace earthshine::raytrace {

// Planes of means over each point's window: <d^2 / e>, <n^2 / e>, <1 / e>, and from Scatter on the
// difference of the first two with random signs.
enum Square : std::size_t { Energy, NoiseSquare, Weight, Scatter };
// Ratio of noise to signal without samples, and of signal to noise where all is kept.
inline constexpr float certain = 1e6F;

// One bit per noise field, then one per scatter field, for each point. The bits depend on the
// samples; otherwise the same neighbours would cancel for every seed, round and kind. Points
// without samples have the signs of the points whose values they take. estimate: of the grid's
// points, and any more.
[[nodiscard]] std::vector<std::uint8_t> draw_signs(const Neighbours& neighbours,
                                                   const Estimate& estimate);
[[nodiscard]] inline float sign_of(std::uint8_t signs, std::size_t field) {
  return 1.0F - 2.0F * static_cast<float>((std::int32_t{signs} >> field) & 1);
}

// Fills signal, noise and inverse_dof of that level. expected: e, 0 without samples.
//
// Chance makes the s / q of windows vary by 2 / N. Each moves toward the mean of all by the
// fraction of the variance that is due to chance (Efron and Morris 1975).
void find_signals(std::size_t level, const Neighbours::Planes& squares,
                  const std::vector<float>& expected, Shared& shared);

}  // namespace earthshine::raytrace
