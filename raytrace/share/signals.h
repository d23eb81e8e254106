// SPDX-License-Identifier: Apache-2.0
// What the details of one level say of their signal and noise (share.h).
#pragma once

#include <vector>

#include "raytrace/share/share.h"

namespace earthshine::raytrace {

// Planes of means over each point's window: <d^2 / e>, <n^2 / e>, <1 / e>, and from the last on the
// first less the second with random signs.
enum Square : std::size_t { Energy, NoiseSquare, Weight, Scatter };
inline constexpr std::size_t scatter_fields = 3;
// Noise over signal of what has no samples, and signal over noise where all is kept.
inline constexpr float certain = 1e6F;

// Fills signal, noise and few of that level. expected: e, 0 without samples.
//
// Chance alone makes the s / q of windows vary by 2 / N. Of what one is off the mean of all as much
// is left out as that is of their variance (Efron and Morris 1975).
void find_signals(std::size_t level, const Neighbours::Planes& squares,
                  const std::vector<float>& expected, Shared& shared);

}  // namespace earthshine::raytrace
