// SPDX-License-Identifier: Apache-2.0
// How wide a strip is that begins at an edge.
#pragma once

#include <array>
#include <optional>

#include "raytrace/tuning.h"

namespace earthshine::raytrace {

// Both edges of a strip report it.
inline constexpr double share_of_edge = 0.5;

// The width of what begins at 0 and holds `is_same` true, up to `wide`: nothing if it ends nowhere.
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
