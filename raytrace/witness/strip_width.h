// SPDX-License-Identifier: Apache-2.0
// How wide a strip is that begins at an edge.
#pragma once

#include <array>
#include <optional>

namespace earthshine::raytrace {

inline constexpr double wide_px = 1.0;  // from there on a strip is none
// Where a strip may end, as shares of wide_px; then bisected.
inline constexpr std::array<double, 4> strip_places = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0};
inline constexpr int strip_bisections = 4;
// Both edges of a strip report it.
inline constexpr double share_of_edge = 0.5;

// The width of what begins at 0 and holds `is_same` true, up to `wide`: nothing if it ends nowhere.
template <class IsSame>
std::optional<double> width_of(double wide, double least, const IsSame& is_same) {
  double low = least;
  for (const double place : strip_places) {
    double high = place * wide;
    if (high <= low) continue;
    if (is_same(high)) {
      low = high;
      continue;
    }
    for (int k = 0; k < strip_bisections; ++k) {
      const double middle = 0.5 * (low + high);
      (is_same(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return std::nullopt;
}

}  // namespace earthshine::raytrace
