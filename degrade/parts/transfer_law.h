// SPDX-License-Identifier: Apache-2.0
// What a camera's settings say, in closed form, about its sharpness and the grain of its noise. The
// certificate holds the chain to this; nothing here uses the code of the chain.
//   T(f)   transfer at f cycles per resel, 1 at f = 0
//   h_n    taps: T(f) = sum h_n cos(2 pi f n)
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "degrade/parts/monitor.h"
#include "degrade/stage/camera.h"

namespace earthshine::degrade {

enum class Axis { Along, Across };  // along a line; from line to line

// What passes a stage: the picture, the noise that comes with the light, the amplifier's noise.
enum class Travels { Picture, LightNoise, AmplifierNoise };

// Product over the stages that blur or sharpen and that `what` passes. The area average onto the
// grid is not among them.
[[nodiscard]] double transfer(const CctvCamera& camera, const Monitor& monitor, Travels what,
                              Axis axis, double frequency);

// Taps h_-k .. h_k, odd in number, sum 1; cut where they fall below 1e-9.
[[nodiscard]] std::vector<double> taps(const CctvCamera& camera, const Monitor& monitor,
                                       Travels what, Axis axis);

// e^-t I_n(t), t = sigma^2, the tap at n of a discrete Gaussian.
[[nodiscard]] double gaussian_tap(double sigma, int n);

struct Filter {
  std::vector<double> along, across;

  // Resels that taps above 1e-5 reach.
  [[nodiscard]] int radius() const;
  // sum over both axes of h^p. p = 2: what white noise's variance is multiplied by.
  [[nodiscard]] double power_sum(int p) const;
  // sum h_n h_(n + k) along times across: what white noise's covariance at (dx, dy) is.
  [[nodiscard]] double covariance(int dx, int dy) const;
};
[[nodiscard]] Filter filter_of(const CctvCamera& camera, const Monitor& monitor, Travels what);

// Share of a square of side 1 on the near side of an edge at distance x from its centre, the edge's
// normal `angle` radians from an axis: the integral of a trapezium.
[[nodiscard]] double edge_coverage(double angle, double x);

// Modulation of an edge whose normal lies `angle` off the axis, area average included:
// T(f cos) T'(f sin) sinc(f cos) sinc(f sin).
[[nodiscard]] double edge_modulation(const CctvCamera& camera, const Monitor& monitor, Axis axis,
                                     double angle, double frequency);
// Profile of that edge at distance x, from 0 far on the dark side to 1.
[[nodiscard]] double edge_profile(const Filter& picture, Axis axis, double angle, double x);

// Monitor: integral of the phosphor's point spread up to x resels. The sinc is windowed (Lanczos, 8
// zeros), by Simpson's rule.
[[nodiscard]] double phosphor_edge(const Monitor& monitor, double x);

// The noise on the line before gamma, as the settings' a, b and c come through the filters and the
// tube's lag.
struct LineNoise {
  // Variances of the settings, before any filter.
  double amplifier = 0.0, dark = 0.0;           // of a
  double light = 0.0, share = 0.0;              // b; c, where it is new in each frame
  double fixed_black = 0.0, fixed_share = 0.0;  // of a and c, the same in every frame
  double lag = 1.0;                             // what the lag leaves of the light's noise in time
  bool two_fields = false;                      // odd lines are of another field
  double field_to_field = 0.0;                  // correlation that the lag makes between the two
  Filter light_filter, amplifier_filter;

  // Covariance of two resels (dx, dy) apart in a flat field of signal S; (0, 0) is the variance.
  [[nodiscard]] double in_time(double signal, int dx = 0, int dy = 0) const;
  [[nodiscard]] double fixed(double signal, int dx = 0, int dy = 0) const;
  // Whether there is noise that signals of single precision near 1 can show.
  [[nodiscard]] bool shows(double signal) const { return total(signal) > 1e-13; }
  [[nodiscard]] double total(double signal, int dx = 0, int dy = 0) const {
    return in_time(signal, dx, dy) + fixed(signal, dx, dy);
  }
  // What white noise of the light, of the amplifier, is multiplied by.
  [[nodiscard]] double light_factor() const { return light_filter.power_sum(2); }
  [[nodiscard]] double amplifier_factor() const { return amplifier_filter.power_sum(2); }
  // Third or fourth cumulant of the counts of light and dark: a count has all its cumulants equal
  // to its mean, and a filter multiplies the p-th by sum h^p. Of a still picture, whose lag is that
  // of degrade::settled_charge. The pattern's share in the fourth is left out.
  [[nodiscard]] double light_cumulant(double signal, int order) const;
};
[[nodiscard]] LineNoise line_noise(const CctvCamera& camera, const Monitor& monitor);

}  // namespace earthshine::degrade
