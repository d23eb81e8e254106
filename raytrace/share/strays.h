// SPDX-License-Identifier: Apache-2.0
// Gather points off the grid: where a pixel shows several surfaces, one for each that is not behind
// its centre. What nearby points of the grid say of the same surface is told apart from what is the
// case there by the stray's own samples, as far as these know better (Wiener, as in share.h):
//   value = shared + c (own - shared),  c = s / (s + q)
// s: mean square of the true difference, q: noise of the stray's own samples, both means over the
// strays of a part of the picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/share/share.h"

namespace earthshine::raytrace {

struct Stray {
  std::uint32_t pixel = 0;  // of the window
  std::uint32_t base =
      0;  // nearest point of the grid on the same surface; no_base if there is none
  std::uint32_t region = 0;  // part of the picture
  float cover = 0.0F;        // about, of the pixel
};
inline constexpr std::uint32_t no_base = 0xffffffffU;

// Completes `shared`, which knows the points of the grid, by the strays: point grid + k of the
// estimate is strays[k].
void add_strays(std::span<const Stray> strays, const Estimate& estimate, Shared& shared);

}  // namespace earthshine::raytrace
