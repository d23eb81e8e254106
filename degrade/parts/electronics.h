// SPDX-License-Identifier: Apache-2.0
// From light on the sensor to the signal on the line. What is point by point there is a PointMap
// (degrade/stage/point_map.h).
#pragma once

#include "degrade/stage/axis_map.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// S = E / E_white.
[[nodiscard]] Picture to_signal(Picture illuminance, double white_lux);

// Signal from which on a resel counts as white.
inline constexpr double white_signal = 0.995;

// Shares of resels at or above white (S >= white_signal) and within the noise of black (S <= gain
// sqrt(a)).
struct Levels {
  double saturated_share = 0.0;
  double crushed_share = 0.0;
};
[[nodiscard]] Levels measure_levels(const Picture& signal, double black_noise);

// The video line: what makes rows differ from columns. RS-170: 525 lines, two fields of 1/60 s, a
// line shows the picture during 52.66 us.

inline constexpr double active_line_us = 52.66;

// Variance t, resel^2, of the discrete Gaussian whose transfer exp(-t (1 - cos 2 pi f)) is
// 1 / sqrt 2 at `bandwidth_mhz` on a screen of `screen_columns` resels to a line, whatever part of
// it the picture takes. From the resels' Nyquist frequency on, the t of the continuous Gaussian.
[[nodiscard]] double bandwidth_variance(double bandwidth_mhz, int screen_columns);

// Along the line: the low pass, then the taps -k/2, 1 + k, -k/2 of an aperture corrector, whose
// transfer is 1 + k (1 - cos 2 pi f). bandwidth_mhz = 0 and k = 0 leave their part out. Symmetric:
// edges are not moved. Row sums are 1, the border is mirrored.
[[nodiscard]] AxisMap line_filter(int columns, double bandwidth_mhz, double aperture_correction,
                                  int screen_columns);

// Rows of even number from `first`, of odd number from `second`. Two equal pictures: that picture.
[[nodiscard]] Picture weave(Picture first, const Picture& second);

}  // namespace earthshine::degrade
