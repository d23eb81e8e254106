// SPDX-License-Identifier: Apache-2.0
// Noise of the linear signal: sigma^2(S) = a + b S + c S^2, S = 1 at white. One law for the 1990
// report, data sheets and EMVA 1288. Random numbers are keyed by (seed, frame, view, stage, plane,
// pixel), so that they do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <string>

#include "base/numbers/random.h"
#include "degrade/stage/camera.h"
#include "degrade/stage/picture.h"

namespace earthshine::degrade {

struct NoiseLaw {
  // a is the amplifier's part; the law's a is a + dark + black_pattern.
  double a = 0.0, b = 0.0, c = 0.0;
  // c is from the different sensitivities of the resels: the same pattern in every frame.
  bool c_is_fixed_pattern = false;
  double dark = 0.0;           // variance of the noise of dark counts, which enters with the light
  double black_pattern = 0.0;  // variance of black over the resels, the same in every frame

  [[nodiscard]] double at_black() const { return a + dark + black_pattern; }
  [[nodiscard]] double variance(double signal) const {
    const double s = signal > 0.0 ? signal : 0.0;
    return at_black() + b * s + c * s * s;
  }
  [[nodiscard]] bool with_light() const { return b > 0.0 || c > 0.0 || dark > 0.0; }
  [[nodiscard]] bool with_amplifier() const { return a > 0.0 || black_pattern > 0.0; }
};

[[nodiscard]] NoiseLaw noise_law(const CctvCamera& camera);

// The law as single figures. Infinite without noise of that kind.
struct NoiseFigures {
  NoiseLaw law;
  double snr_db = 0.0;              // at white: -10 lg(a + b + c)
  double floor_db = 0.0;            // white over the noise of black: -10 lg of the whole a
  double percent_of_signal = 0.0;   // 100 sqrt(c)
  double electrons_at_white = 0.0;  // 1 / b: Poisson counts that would give b
};
[[nodiscard]] NoiseFigures noise_figures(const CctvCamera& camera);
// One line: "a = ..., b = ..., c = ...: SNR ... dB at white, ...".
[[nodiscard]] std::string describe_noise(const CctvCamera& camera);

struct NoiseKey {
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;  // or number of the field
  std::uint64_t view = 0;   // distinguishes the cameras of a run
};

// Fixed pattern of sensitivities: S <- S (1 + sqrt(c) normal); the pattern has the mean 1. Only if
// c is a fixed pattern.
[[nodiscard]] Picture differ_in_sensitivity(Picture signal, const NoiseLaw& law,
                                            const NoiseKey& key);
// Temporal noise: counts of light and dark (variance b S + dark), and c if it is not a fixed
// pattern (Gaussian). Below 64 electrons counts are exactly Poisson, above a continuous variable
// with the first four moments of Poisson (Cornish and Fisher 1938). The mean is S.
[[nodiscard]] Picture add_grain(Picture signal, const NoiseLaw& law, const NoiseKey& key);
// Both, where light becomes signal.
[[nodiscard]] Picture add_signal_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key);
// Noise of the amplifier, a, and the pattern of black; Gaussian.
[[nodiscard]] Picture add_read_noise(Picture signal, const NoiseLaw& law, const NoiseKey& key);

// Standard normal quantile, 16 digits (Wichura 1988, AS 241). 0 < p < 1.
[[nodiscard]] double normal_quantile(double p);
// Poisson variate of the given mean from one uniform number in [0, 1).
[[nodiscard]] double poisson_quantile(double mean, double uniform);

}  // namespace earthshine::degrade
