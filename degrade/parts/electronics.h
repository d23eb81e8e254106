// SPDX-License-Identifier: Apache-2.0
// Point by point from light on the sensor to the signal on the line.
#pragma once

#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// S = E / E_white.
[[nodiscard]] Picture to_signal(Picture illuminance, double white_lux);
[[nodiscard]] Picture limit_below_zero(Picture signal);
[[nodiscard]] Picture amplify(Picture signal, double gain);
// v = S^(1/gamma); a signal below black is black.
[[nodiscard]] Picture encode_gamma(Picture signal, double gamma);
// The nearest of 2^bits levels from 0 to 1.
[[nodiscard]] Picture quantise(Picture line_signal, int bits);

// Signal from which on a resel counts as white.
inline constexpr double white_signal = 0.995;

// Shares of resels at or above white (S >= white_signal) and within the noise of black (S <= gain
// sqrt(a)).
struct Levels {
  double saturated_share = 0.0;
  double crushed_share = 0.0;
};
[[nodiscard]] Levels measure_levels(const Picture& signal, double black_noise);

}  // namespace earthshine::degrade
