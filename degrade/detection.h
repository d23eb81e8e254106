// SPDX-License-Identifier: Apache-2.0
// Whether a small target would be seen, at every place of the picture at once, without drawing any
// noise: Rose's k and the probability of detection after Rosell and Willson.
//   target      size x size resels around each resel
//   surround    the (2 size + 1)^2 resels around the same resel, without the target
//   signal      |mean over the target - mean over the surround| of the noise-free signal; 0 where
//   it
//               is within the rounding of floats
//   noise       standard deviation of that very difference, from the full covariance of the noise
//   SNR_D       signal / noise. In white noise sigma that is signal * sqrt(N_eff) / sigma with
//               1 / N_eff = 1 / N_target + 1 / N_surround
//   P           Phi(SNR_D - 2.8): 2.8 is seen in half of all cases, 5 almost surely
// At the border the parts of both boxes inside the picture count; where no surround is left there
// is no signal.
#pragma once

#include "degrade/moments/noise_moments.h"

namespace earthshine::degrade {

struct DetectionOptions {
  int target_resels = 5;  // odd, 1 to 199
  double even_chance_snr =
      2.8;  // SNR_D that is seen in half of all cases (Rosell and Willson 1973)
};

// What has no noise would have an infinite signal-to-noise ratio; 120 dB stands for it.
inline constexpr double most_snr = 1e6;

struct Detection {
  Plane signal, noise;  // in the unit of the signal
  Plane snr;            // SNR_D, at most most_snr; 0 where there is no signal
  Plane probability;
};
// Throws base::Error if the options or the sizes are not allowed.
[[nodiscard]] Detection detection(const Plane& mean, const Covariance& noise,
                                  const DetectionOptions& options = {});

// mean / sigma of each pixel, from -most_snr to most_snr; 0 where the mean is 0.
[[nodiscard]] Plane local_snr(const Plane& mean, const Plane& variance);

}  // namespace earthshine::degrade
