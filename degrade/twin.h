// SPDX-License-Identifier: Apache-2.0
// Analytic twin of a noisy picture: the noise-free picture, the mean and the variance of every
// pixel, and the visibility of a target, computed without random numbers.
#pragma once

#include "degrade/chain.h"
#include "degrade/moments/noise_moments.h"

namespace earthshine::degrade {

// Visibility of a small target at every position, computed without random numbers: Rose's k and the
// probability of detection (Rosell and Willson 1973).
//   target      size x size resels around each resel
//   surround    (2 size + 1)^2 resels around the same resel, without the target
//   signal      |mean over the target - mean over the surround| of the noise-free signal; 0 if
//               it is within float rounding
//   noise       standard deviation of this difference, from the full covariance of the noise
//   SNR_D       signal / noise. In white noise sigma: signal * sqrt(N_eff) / sigma with
//               1 / N_eff = 1 / N_target + 1 / N_surround
//   P           Phi(SNR_D - 2.8): SNR_D = 2.8 is detected in half of all cases, 5 almost surely
// At the border both boxes are cut to the picture. Without a surround the signal is 0.

struct DetectionOptions {
  int target_resels = 5;  // odd, 1 to 199
  double even_chance_snr =
      2.8;  // SNR_D that is detected in half of all cases (Rosell and Willson 1973)
};

// Limit of signal-to-noise ratios, 120 dB: they would be infinite without noise.
inline constexpr double most_snr = 1e6;

struct Detection {
  Plane signal, noise;  // in the unit of the signal
  Plane snr;            // SNR_D, at most most_snr; 0 without a signal
  Plane probability;
};
// Throws base::Error if the options or the sizes are invalid.
[[nodiscard]] Detection detection(const Plane& mean, const Covariance& noise,
                                  const DetectionOptions& options = {});

// mean / sigma of each pixel, from -most_snr to most_snr; 0 where the mean is 0.
[[nodiscard]] Plane local_snr(const Plane& mean, const Plane& variance);

struct Twin {
  // Line signal v on the sensor's grid, with the planes of the picture.
  Picture signal;    // without noise
  Picture mean;      // of the noisy signal; clamps and gamma make it differ from `signal`
  Picture variance;  // of the noisy signal
  // The same for the luminance of the screen, cd/m^2 and (cd/m^2)^2.
  Picture viewed, viewed_mean, viewed_variance;
  // For the luminance of the line signal, on the sensor's grid.
  Plane snr;            // mean / sigma of each resel
  Detection detection;  // of a target of the wanted size around each resel
  Plane saturated;      // 1 if the noise-free signal is at white (S >= 0.995), else 0
  Plane crushed;        // 1 if it is within the noise of black (S <= G sqrt(a)), else 0
  Memory memory;        // of the noise-free camera, for the next frame
};

// The twin of degrade::degrade with the same arguments; `before` is the memory of the twin. For
// cameras with lag the noise is computed for a still scene. Throws as degrade does.
[[nodiscard]] Twin twin(const base::Image& radiance, const CctvCamera& camera,
                        const Monitor& monitor, const Options& options = {},
                        const DetectionOptions& target = {}, const Memory& before = {});

// Channels Y or R, G, B (noisy), and with the prefixes "twin", "mean", "variance" on the pixels of
// the screen; "snr.Y", "detection.snr.Y", "detection.probability.Y", "saturated.Y" and "crushed.Y"
// of the resel that contains a pixel. noisy: the result for which the twin was computed.
[[nodiscard]] base::Image to_image(const Twin& twin, const Result& noisy);

}  // namespace earthshine::degrade
