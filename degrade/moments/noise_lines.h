// SPDX-License-Identifier: Apache-2.0
// What noise_moments is made of: whole lines of pixels at a time, so that the loops over a line's
// pixels are plain ones. Sums along lines are sums across the transposed picture.
#pragma once

#include <cstddef>

#include "degrade/moments/noise_moments.h"

namespace earthshine::degrade {

[[nodiscard]] inline std::size_t size(int n) { return static_cast<std::size_t>(n); }

// Columns become rows; z = (x, y) goes to (y, x) and d = (dx, dy) to (dy, dx).
[[nodiscard]] Plane transposed(const Plane& in, int columns, int rows);
[[nodiscard]] Covariance transposed(const Covariance& noise);

[[nodiscard]] bool is_identity(const AxisMap& map);

// out line i += factor * sum over k of weight[k] * in line source[k]; lines of `width` values.
void add_lines(Plane& out, const Plane& in, std::size_t width, const AxisMap& map, double factor);

// C' = W C W^T across lines; W keeps the number of lines.
[[nodiscard]] Covariance filtered_across(const Covariance& noise, const AxisMap& map);

}  // namespace earthshine::degrade
