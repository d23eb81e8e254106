// SPDX-License-Identifier: Apache-2.0
// Effects of a tube's target or a chip other than noise: lag, smear, bloom, saturation.
#pragma once

#include <cstddef>

#include "degrade/parts/noise.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// y = (1 - lag) now + lag before: a share of the last field remains on the target. DC gain 1. After
// j fields (1 - lag) lag^j of a flash remains.
[[nodiscard]] Picture after_lag(Picture now, const Picture& before, double lag);

// Charge on the target after a long still scene: the signal with its grain, whose deviation is
// smaller by sqrt((1 - lag) / (1 + lag)), from the variance of a first-order recursion of white
// noise. still: the signal before its grain.
[[nodiscard]] Picture settled_charge(const Picture& still, const NoiseLaw& law, const NoiseKey& key,
                                     double lag);

// S <- S + 10 share mean(column): charge collected under bright columns while the picture is
// shifted out of the chip. share: smear of a patch of a tenth of the picture's height, over its
// signal.
[[nodiscard]] Picture smear_columns(Picture signal, double share);

// The share `bloom` of the signal above `most` spreads as a Gaussian of sigma `radius` resels,
// mirrored at the border; the rest is drained. Sum out = sum in - (1 - bloom) sum of the excess.
[[nodiscard]] Picture bloom_over(Picture signal, double most, double bloom, double radius);

[[nodiscard]] Picture limit_above(Picture signal, double most);

// Sum of the excess above `most`, over the sum of all; 0 for a black picture.
[[nodiscard]] double share_above(const Picture& signal, double most);

}  // namespace earthshine::degrade
