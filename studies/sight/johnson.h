// SPDX-License-Identifier: Apache-2.0
// How large a target is in a picture, and what a viewer makes of so many cycles across it.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::studies {

// Never detect < recognise, nor recognise < identify.
struct Probability {
  double detect = 0.0, recognise = 0.0, identify = 0.0;
};

// Cycles across the least extent at which half of all viewers do it (Johnson 1958).
struct CyclesNeeded {
  double detect = 1.0, recognise = 4.0, identify = 6.4;
};

// P = r^q / (1 + r^q), r = cycles / needed, q = 2.7 + 0.7 r: the target transfer probability
// function of the night vision laboratory. 0 for no cycles, 1/2 at r = 1.
[[nodiscard]] double johnson_probability(double cycles, double needed);
[[nodiscard]] Probability johnson_probability(double cycles, const CyclesNeeded& needed);

// The least extent of a set of pixels: the least distance of two parallel lines that hold all of
// them; or the diameter of the disc of as many pixels, where that is less, so that a few pixels far
// apart do not count as something large.
struct Extent {
  double pixels = 0.0;
  double direction_rad = 0.0;  // of the extent, from the picture's x to its y (down)
  double angle_deg = 0.0;      // between the rays to its ends
};
// pixels: at least one, indices in ascending order into a picture of columns x rows.
[[nodiscard]] Extent least_extent(const std::vector<std::uint32_t>& pixels,
                                  const scenes::Camera& camera, int columns, int rows);

}  // namespace earthshine::studies
