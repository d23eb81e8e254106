// SPDX-License-Identifier: Apache-2.0
// What the details of one level say of their signal and noise (share.h).
#pragma once

#include <vector>

#include "raytrace/share/share.h"

namespace earthshine::raytrace {

// Planes of means over each point's window: <d^2 / e>, <n^2 / e>, <1 / e>, and from the last on the
// first less the second with random signs.
enum Square : std::size_t { Energy, NoiseSquare, Weight, Scatter };
// Noise over signal of what has no samples, and signal over noise where all is kept.
inline constexpr float certain = 1e6F;

// A bit for every field of noise, and behind them of scatter, of each point: other ones for other
// samples, or which noise cancels where would be the same for every seed, round and kind. Points
// without samples say what those around them do, and have the signs of these. estimate: of the
// grid's points, and any more.
[[nodiscard]] std::vector<std::uint8_t> draw_signs(const Neighbours& neighbours,
                                                   const Estimate& estimate);
[[nodiscard]] inline float sign_of(std::uint8_t signs, std::size_t field) {
  return 1.0F - 2.0F * static_cast<float>((std::int32_t{signs} >> field) & 1);
}

// Fills signal, noise and few of that level. expected: e, 0 without samples.
//
// Chance alone makes the s / q of windows vary by 2 / N. Of what one is off the mean of all as much
// is left out as that is of their variance (Efron and Morris 1975).
void find_signals(std::size_t level, const Neighbours::Planes& squares,
                  const std::vector<float>& expected, Shared& shared);

}  // namespace earthshine::raytrace
