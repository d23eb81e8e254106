// SPDX-License-Identifier: Apache-2.0
// Noise of the linear signal: sigma^2(S) = a + b S + c S^2, S = 1 at white. One law for the 1990
// report, for data sheets and for EMVA 1288. Keyed by (seed, frame, view, stage, plane, pixel): the
// same on any number of threads.
#pragma once

#include <cstdint>
#include <string>

#include "base/numbers/random.h"
#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

struct NoiseLaw {
  // a is the amplifier's part; with dark and black_pattern it makes the a of the law.
  double a = 0.0, b = 0.0, c = 0.0;
  // c comes from differing sensitivity of the resels: the same pattern in every frame.
  bool c_is_fixed_pattern = false;
  double dark = 0.0;           // dark counts: variance of their noise, which enters with the light
  double black_pattern = 0.0;  // black differs from resel to resel, the same in every frame

  [[nodiscard]] double at_black() const { return a + dark + black_pattern; }
  [[nodiscard]] double variance(double signal) const {
    const double s = signal > 0.0 ? signal : 0.0;
    return at_black() + b * s + c * s * s;
  }
  [[nodiscard]] bool with_light() const { return b > 0.0 || c > 0.0 || dark > 0.0; }
  [[nodiscard]] bool with_amplifier() const { return a > 0.0 || black_pattern > 0.0; }
};

[[nodiscard]] NoiseLaw noise_law(const CctvCamera& camera);

// The same law in the words of those who quote one number. Infinite where there is no noise of that
// kind.
struct NoiseFigures {
  NoiseLaw law;
  double snr_db = 0.0;              // at white: -10 lg(a + b + c)
  double floor_db = 0.0;            // white over the noise of black: -10 lg a, all of a
  double percent_of_signal = 0.0;   // 100 sqrt(c)
  double electrons_at_white = 0.0;  // 1 / b: Poisson counts that would give b
};
[[nodiscard]] NoiseFigures noise_figures(const CctvCamera& camera);
// One line: "a = ..., b = ..., c = ...: SNR ... dB at white, ...".
[[nodiscard]] std::string describe_noise(const CctvCamera& camera);

struct NoiseKey {
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;  // or number of the field
  std::uint64_t view = 0;   // tells the cameras of one run apart
};

// What differs from resel to resel and stays: S <- S (1 + sqrt(c) normal), mean of the pattern 1.
// Only where c is a fixed pattern.
[[nodiscard]] Picture differ_in_sensitivity(Picture signal, const NoiseLaw& law,
                                            const NoiseKey& key);
// What is drawn anew: counts of light and dark (variance b S + dark), and c where it is no fixed
// pattern (Gaussian). Counts: exact Poisson below 64 electrons, above that a continuous variable
// with the Poisson law's first four moments (Cornish and Fisher 1938); their mean stays S.
[[nodiscard]] Picture add_grain(Picture signal, const NoiseLaw& law, const NoiseKey& key);
// Both, where the light becomes signal.
[[nodiscard]] Picture add_signal_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key);
// Part a, in the amplifier, and the pattern of black: Gaussian.
[[nodiscard]] Picture add_read_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key);

// Standard normal quantile, 16 digits (Wichura 1988, AS 241). 0 < p < 1.
[[nodiscard]] double normal_quantile(double p);
// Poisson variate of the given mean from one uniform number in [0, 1).
[[nodiscard]] double poisson_quantile(double mean, double uniform);

}  // namespace earthshine::degrade
