// SPDX-License-Identifier: Apache-2.0
// What the unaided eye tells apart, by the luminance it is adapted to.
#pragma once

namespace earthshine::studies {

// The least luminance difference that an eye adapted to `luminance` (cd/m^2) sees, cd/m^2: the
// lower of the thresholds of cones and rods, with x = log10 L_a (Ferwerda, Pattanaik, Shirley,
// Greenberg 1996):
//   cones  log10 dL = -0.72 for x <= -2.6, x - 1.255 for x >= 1.9,
//                     (0.249 x + 0.65)^2.7 - 0.72 in between
//   rods   log10 dL = -2.86 for x <= -3.94, x - 0.395 for x >= -1.44,
//                     (0.405 x + 1.6)^2.18 - 2.86 in between
[[nodiscard]] double threshold_difference(double luminance);

// Finest grating that it resolves, cycles per degree, never below 0: 17.25 atan(1.4 log10 L_a +
// 0.35) + 25.72 (Ward Larson, Rushmeier, Piatko 1997, after Shlaer 1937).
[[nodiscard]] double acuity_cycles_per_deg(double luminance);

struct EyeOptions {
  double slope = 3.5;  // beta of the psychometric function; 3.5 for luminance contrast (Quick 1974)
  double threshold_factor = 1.0;  // on the least difference that is seen; 0: any is
};

// Of seeing a difference `ratio` times the threshold: P = 1 - 2^-(ratio^beta), 1/2 at threshold
// (Weibull's form after Quick 1974, without guessing).
[[nodiscard]] double seeing_probability(double ratio, const EyeOptions& options = {});

}  // namespace earthshine::studies
