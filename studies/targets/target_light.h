// SPDX-License-Identifier: Apache-2.0
// Luminance of a target and of its surround (docs/studies.md has the formulas and thresholds).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "studies/targets/target_view.h"

namespace earthshine::studies {

// Luminance of a target and its surround, cd/m^2, and C_W = (L_t - L_b) / L_b.
struct TargetLight {
  double luminance = 0.0;          // mean over TargetView::measured
  std::optional<double> surround;  // mean; empty if the target fills the picture
  std::optional<double> contrast;  // Weber; empty without a surround or if that is black
};

// Empty if the target is not in view. `luminance` per pixel, from base::luminance_of.
[[nodiscard]] std::optional<TargetLight> measure_light(const TargetView& view,
                                                       const std::vector<float>& luminance);

// The mean of the values at these pixels, at least one.
[[nodiscard]] double mean_over(const std::vector<float>& values,
                               const std::vector<std::uint32_t>& pixels);

}  // namespace earthshine::studies
