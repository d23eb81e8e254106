// SPDX-License-Identifier: Apache-2.0
// Conversion between the forms in which noise is quoted: SNR in dB, the law's a, b and c,
// electrons.
//   sigma^2(S) = a + b S + c S^2, S = 1 at white: of one resel, before blur, gain and gamma
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "degrade/stage/camera.h"

namespace earthshine::degrade {

// SNR(S) = 20 lg(S / sigma(S)) dB. Infinite without noise of that kind.
struct NoiseWords {
  double a = 0.0, b = 0.0, c = 0.0;
  double snr_white_db = 0.0;
  double snr_half_db = 0.0;         // at 50 % of white
  double snr_dark_db = 0.0;         // at 5 % of white
  double floor_db = 0.0;            // white over the noise of black: -10 lg a
  double percent_at_white = 0.0;    // 100 sigma(1)
  double percent_of_signal = 0.0;   // 100 sqrt(c): the part proportional to the signal
  double electrons_at_white = 0.0;  // 1 / b: Poisson counts that would give b
  double read_electrons = 0.0;      // sqrt(a) / b: rms noise of the amplifier in such counts; 0 if
                                    // b = 0
  // After v = S^(1/gamma): sigma_v = sigma S^(1/gamma - 1) / gamma, so that v / sigma_v =
  // gamma S / sigma, the same number of decibels more at every level.
  double line_sigma_white = 0.0;  // sigma_v at white
  double line_snr_white_db = 0.0;
  double gamma_db = 0.0;  // 20 lg gamma: SNR on the line minus SNR of S
};
[[nodiscard]] NoiseWords noise_words(const CctvCamera& camera);

// Settings of a [[cctv]] table that give this noise in another form.
struct NoiseForm {
  NoiseMode mode = NoiseMode::None;
  std::vector<std::pair<std::string, double>> settings;
  // "": equal at every level; otherwise the limitation, e.g. "the same at white".
  std::string differs;
};
// The forms within the limits of the keys; none for a camera without noise.
[[nodiscard]] std::vector<NoiseForm> other_forms(const CctvCamera& camera);

}  // namespace earthshine::degrade
