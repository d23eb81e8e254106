// SPDX-License-Identifier: Apache-2.0
// The size of a target in a picture, and a viewer's probabilities for a number of cycles across it.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::studies {

// Ordered: detect >= recognise >= identify.
struct Probability {
  double detect = 0.0, recognise = 0.0, identify = 0.0;
};

// Cycles across the least extent at which half of all viewers succeed (Johnson 1958).
struct CyclesNeeded {
  double detect = 1.0, recognise = 4.0, identify = 6.4;
};

// P = r^q / (1 + r^q), r = cycles / needed, q = 2.7 + 0.7 r: the target transfer probability
// function of the Night Vision Laboratory. 0 for no cycles, 1/2 at r = 1.
[[nodiscard]] double johnson_probability(double cycles, double needed);
[[nodiscard]] Probability johnson_probability(double cycles, const CyclesNeeded& needed);

// The least extent of a set of pixels: the least distance of two parallel lines that enclose them;
// or the diameter of a disc of equal area if that is less, so that a few scattered pixels do not
// count as a large target.
struct Extent {
  double pixels = 0.0;         // heights of a pixel
  double direction_rad = 0.0;  // of the extent, from the picture's x to its y (down)
  double angle_deg = 0.0;      // between the rays to its ends
};
// pixels: at least one, indices in ascending order into a picture of columns x rows.
[[nodiscard]] Extent least_extent(const std::vector<std::uint32_t>& pixels,
                                  const scenes::Camera& camera, int columns, int rows);

// The least luminance difference that an unaided eye adapted to `luminance` (cd/m^2) sees, cd/m^2:
// the lower of the thresholds of cones and rods, with x = log10 L_a (Ferwerda, Pattanaik, Shirley,
// Greenberg 1996):
//   cones  log10 dL = -0.72 for x <= -2.6, x - 1.255 for x >= 1.9,
//                     (0.249 x + 0.65)^2.7 - 0.72 in between
//   rods   log10 dL = -2.86 for x <= -3.94, x - 0.395 for x >= -1.44,
//                     (0.405 x + 1.6)^2.18 - 2.86 in between
[[nodiscard]] double threshold_difference(double luminance);

// Finest grating that the eye resolves, cycles per degree, at least 0: 17.25
// atan(1.4 log10 L_a + 0.35) + 25.72 (Ward Larson, Rushmeier, Piatko 1997, after Shlaer 1937).
[[nodiscard]] double acuity_cycles_per_deg(double luminance);

struct EyeOptions {
  double slope = 3.5;  // beta of the psychometric function; 3.5 for luminance contrast (Quick 1974)
  double threshold_factor = 1.0;  // on the threshold difference; 0: no threshold
};

// Probability of seeing a difference `ratio` times the threshold: P = 1 - 2^-(ratio^beta), 1/2 at
// threshold (Weibull's form after Quick 1974, without guessing).
[[nodiscard]] double seeing_probability(double ratio, const EyeOptions& options = {});

}  // namespace earthshine::studies
