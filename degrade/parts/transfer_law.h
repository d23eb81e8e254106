// SPDX-License-Identifier: Apache-2.0
// Closed forms of a camera's sharpness and grain, from its settings. The certificate compares the
// chain with them; they share no code with the chain.
//   T(f)   transfer at f cycles per resel, 1 at f = 0
//   h_n    taps: T(f) = sum h_n cos(2 pi f n)
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "degrade/parts/monitor.h"
#include "degrade/stage/camera.h"

namespace earthshine::degrade {

enum class Axis { Along, Across };  // along a line; across the lines

// Signals through a stage: the picture, the noise of the light, the noise of the amplifier.
enum class Travels { Picture, LightNoise, AmplifierNoise };

// Product over the blurring and sharpening stages that `what` passes, without the area average onto
// the grid.
[[nodiscard]] double transfer(const CctvCamera& camera, const Monitor& monitor, Travels what,
                              Axis axis, double frequency);

// Taps h_-k .. h_k, an odd number with the sum 1, truncated below 1e-9.
[[nodiscard]] std::vector<double> taps(const CctvCamera& camera, const Monitor& monitor,
                                       Travels what, Axis axis);

// Tap n of a discrete Gaussian: e^-t I_n(t), t = sigma^2.
[[nodiscard]] double gaussian_tap(double sigma, int n);

struct Filter {
  std::vector<double> along, across;

  // Largest offset of a tap above 1e-5, resels.
  [[nodiscard]] int radius() const;
  // Sum of h^p over both axes. p = 2: factor on the variance of white noise.
  [[nodiscard]] double power_sum(int p) const;
  // sum h_n h_(n + k) along times across: covariance at (dx, dy) of filtered white noise.
  [[nodiscard]] double covariance(int dx, int dy) const;
};
[[nodiscard]] Filter filter_of(const CctvCamera& camera, const Monitor& monitor, Travels what);

// Share of a square of side 1 on the near side of an edge at distance x from its centre. The edge's
// normal is `angle` radians off an axis. The integral of a trapezium.
[[nodiscard]] double edge_coverage(double angle, double x);

// Modulation of an edge whose normal is `angle` off the axis, with the area average:
// T(f cos) T'(f sin) sinc(f cos) sinc(f sin).
[[nodiscard]] double edge_modulation(const CctvCamera& camera, const Monitor& monitor, Axis axis,
                                     double angle, double frequency);
// Profile of this edge at distance x, from 0 far on the dark side to 1.
[[nodiscard]] double edge_profile(const Filter& picture, Axis axis, double angle, double x);

// Integral of the phosphor's point spread up to x resels. The sinc is windowed (Lanczos, 8 zeros)
// and integrated by Simpson's rule.
[[nodiscard]] double phosphor_edge(const Monitor& monitor, double x);

// Noise on the line before gamma: the settings' a, b and c after the filters and the tube's lag.
struct LineNoise {
  // Variances of the settings, before any filter.
  double amplifier = 0.0, dark = 0.0;           // parts of a
  double light = 0.0, share = 0.0;              // b; c, unless it is a fixed pattern
  double fixed_black = 0.0, fixed_share = 0.0;  // parts of a and c that are the same in every frame
  double lag = 1.0;                             // factor of the lag on the light's noise in time
  bool two_fields = false;                      // odd lines belong to another field
  double field_to_field = 0.0;                  // correlation of the two fields by lag
  Filter light_filter, amplifier_filter;

  // Covariance of two resels at distance (dx, dy) in a flat field of signal S; (0, 0): variance.
  [[nodiscard]] double in_time(double signal, int dx = 0, int dy = 0) const;
  [[nodiscard]] double fixed(double signal, int dx = 0, int dy = 0) const;
  // Whether the noise is above the rounding of single precision for signals near 1.
  [[nodiscard]] bool shows(double signal) const { return total(signal) > 1e-13; }
  [[nodiscard]] double total(double signal, int dx = 0, int dy = 0) const {
    return in_time(signal, dx, dy) + fixed(signal, dx, dy);
  }
  // Factors of the filters on the variance of white noise of the light and of the amplifier.
  [[nodiscard]] double light_factor() const { return light_filter.power_sum(2); }
  [[nodiscard]] double amplifier_factor() const { return amplifier_filter.power_sum(2); }
  // Third or fourth cumulant of the counts of light and dark. All cumulants of a Poisson count
  // equal its mean, and a filter multiplies the p-th one by sum h^p. For a still picture with the
  // lag of degrade::settled_charge. Neglects the pattern's part of the fourth cumulant.
  [[nodiscard]] double light_cumulant(double signal, int order) const;
};
[[nodiscard]] LineNoise line_noise(const CctvCamera& camera, const Monitor& monitor);

}  // namespace earthshine::degrade
