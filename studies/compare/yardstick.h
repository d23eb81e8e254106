// SPDX-License-Identifier: Apache-2.0
// What every picture of a comparison is held against, and how sure that makes of a target.
#pragma once

#include <optional>
#include <vector>

#include "studies/compare/compare.h"

namespace earthshine::studies {

// Luminance per pixel of the two references and of their mean.
struct Yardstick {
  std::vector<float> first, second, mean;
};

// As `targets`; none: not in view. image: with the layer "variance". The noise of a target's
// luminance: of the mean over its pixels, with pixels as independent; the picture's from its
// variance layer, the reference's from the difference of the two. Neighbours that share gather rays
// are not independent, so that the picture's own part is a lower bound.
[[nodiscard]] std::vector<std::optional<TargetDifference>> target_differences(
    const base::Image& image, const std::vector<TargetView>& targets, const Yardstick& right);

// Whether two standard deviations of noise, of ratio and contrast each, leave `misleads` as it is.
[[nodiscard]] bool decided(const TargetDifference& difference);

}  // namespace earthshine::studies
