// SPDX-License-Identifier: Apache-2.0
// The width of a strip that begins at an edge.
#pragma once

#include <array>
#include <optional>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {

// Both edges of a strip report it.
inline constexpr double share_of_edge = 0.5;

// The width of the strip that begins at 0 and in which `is_same` is true, between `least` and
// `wide`; empty if it is wider.
template <class IsSame>
std::optional<double> width_of(double wide, double least, const IsSame& is_same) {
  double low = least;
  for (const double place : tuning::strip_places) {
    double high = place * wide;
    if (high <= low) continue;
    if (is_same(high)) {
      low = high;
      continue;
    }
    for (int k = 0; k < tuning::strip_bisections; ++k) {
      const double middle = 0.5 * (low + high);
      (is_same(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return std::nullopt;
}

}  // namespace earthshine::raytrace
