// SPDX-License-Identifier: Apache-2.0
// What a tube's target or a chip does to the signal besides making noise.
#pragma once

#include <cstddef>

#include "degrade/parts/noise.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// y = (1 - lag) now + lag before: a share of the last field is still on the target. DC gain 1; a
// flash is left with (1 - lag) lag^j after j fields.
[[nodiscard]] Picture after_lag(Picture now, const Picture& before, double lag);

// What stands on the target after an endless still scene: light with its grain, whose deviation is
// smaller by sqrt((1 - lag) / (1 + lag)), the variance of a first-order recursion of white noise.
// still: the signal before its grain.
[[nodiscard]] Picture settled_charge(const Picture& still, const NoiseLaw& law, const NoiseKey& key,
                                     double lag);

// S <- S + 10 share mean(column): charge that the shift out of the chip collects under bright
// columns. share: what a patch of a tenth of the picture's height leaves, over its signal.
[[nodiscard]] Picture smear_columns(Picture signal, double share);

// Of the signal above `most`, the share `bloom` flows to the surround, by a Gaussian of sigma
// `radius` resels mirrored at the border; the rest is drained. Sum out = sum in - (1 - bloom) sum
// of the excess.
[[nodiscard]] Picture bloom_over(Picture signal, double most, double bloom, double radius);

[[nodiscard]] Picture limit_above(Picture signal, double most);

// Sum of what lies above `most`, over the sum of all; 0 for a black picture.
[[nodiscard]] double share_above(const Picture& signal, double most);

}  // namespace earthshine::degrade
