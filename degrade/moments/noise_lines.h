// SPDX-License-Identifier: Apache-2.0
// Helpers of noise_moments that process whole lines of pixels in simple loops. Sums along lines are
// sums across lines of the transposed picture.
#pragma once

#include <cstddef>

#include "degrade/moments/noise_moments.h"

namespace earthshine::degrade {

[[nodiscard]] inline std::size_t size(int n) { return static_cast<std::size_t>(n); }

// Transposes: z = (x, y) becomes (y, x), d = (dx, dy) becomes (dy, dx).
[[nodiscard]] Plane transposed(const Plane& in, int columns, int rows);
[[nodiscard]] Covariance transposed(const Covariance& noise);

[[nodiscard]] bool is_identity(const AxisMap& map);

// out line i += factor * sum over k of weight[k] * in line source[k]; lines of `width` values.
void add_lines(Plane& out, const Plane& in, std::size_t width, const AxisMap& map, double factor);

// C' = W C W^T across lines; W does not change the number of lines.
[[nodiscard]] Covariance filtered_across(const Covariance& noise, const AxisMap& map);

}  // namespace earthshine::degrade
