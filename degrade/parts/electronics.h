// SPDX-License-Identifier: Apache-2.0
// From light on the sensor to the signal on the line. Point operations are in PointMap
// (degrade/stage/point_map.h).
#pragma once

#include "degrade/stage/axis_map.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

// S = E / E_white.
[[nodiscard]] Picture to_signal(Picture illuminance, double white_lux);

// Signal from which a resel counts as white.
inline constexpr double white_signal = 0.995;

// Shares of resels at or above white (S >= white_signal) and within the noise of black (S <= gain
// sqrt(a)).
struct Levels {
  double saturated_share = 0.0;
  double crushed_share = 0.0;
};
[[nodiscard]] Levels measure_levels(const Picture& signal, double black_noise);

// The video line, which distinguishes rows from columns. RS-170: 525 lines, two fields of 1/60 s,
// 52.66 us of picture per line.

inline constexpr double active_line_us = 52.66;

// Variance t, resel^2, of the discrete Gaussian whose transfer exp(-t (1 - cos 2 pi f)) is 1 / sqrt
// 2 at `bandwidth_mhz`. A line has `screen_columns` resels, also if the picture is narrower. From
// the Nyquist frequency of the resels on, t of the continuous Gaussian.
[[nodiscard]] double bandwidth_variance(double bandwidth_mhz, int screen_columns);

// Filter along the line: the low pass, then an aperture corrector with the taps -k/2, 1 + k, -k/2
// and the transfer 1 + k (1 - cos 2 pi f). bandwidth_mhz = 0 or k = 0 omits its part. Symmetric, so
// that edges do not move. Row sums are 1; borders are mirrored.
[[nodiscard]] AxisMap line_filter(int columns, double bandwidth_mhz, double aperture_correction,
                                  int screen_columns);

// Even rows of `first` and odd rows of `second`. Two equal pictures give the same picture.
[[nodiscard]] Picture weave(Picture first, const Picture& second);

}  // namespace earthshine::degrade
