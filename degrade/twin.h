// SPDX-License-Identifier: Apache-2.0
// The analytic twin of a noisy picture: what it is without noise, what it is on average, and the
// variance of every pixel, all without drawing a number; and what that means for seeing a target.
#pragma once

#include "degrade/chain.h"
#include "degrade/moments/noise_moments.h"

namespace earthshine::degrade {

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

struct Twin {
  // On the sensor's grid, of the line signal v; planes as those of the picture.
  Picture signal;    // without noise
  Picture mean;      // of the noisy signal: clamps and gamma move it away from `signal`
  Picture variance;  // of the noisy signal
  // The same of what the viewer sees, cd/m^2 and (cd/m^2)^2.
  Picture viewed, viewed_mean, viewed_variance;
  // Of the luminance of the line signal, on the sensor's grid.
  Plane snr;            // mean / sigma of each resel
  Detection detection;  // of a target of the size asked for around each resel
  Plane saturated;      // 1 where the noise-free signal is at white (S >= 0.995), else 0
  Plane crushed;        // 1 where it is within the noise of black (S <= G sqrt(a)), else 0
  Memory memory;        // of the noise-free camera, for the next frame
};

// Of degrade::degrade for the same arguments; `before` is the twin's own memory. A camera that lags
// is taken to have looked at a still scene as far as its noise goes. Throws as degrade does.
[[nodiscard]] Twin twin(const base::Image& radiance, const CctvCamera& camera,
                        const Monitor& monitor, const Options& options = {},
                        const DetectionOptions& target = {}, const Memory& before = {});

// Channels Y or R, G, B (noisy), and with the prefixes "twin", "mean", "variance" on the screen's
// pixels; "snr.Y", "detection.snr.Y", "detection.probability.Y", "saturated.Y" and "crushed.Y" of
// the resel that a pixel belongs to. noisy: the result that the twin belongs to.
[[nodiscard]] base::Image to_image(const Twin& twin, const Result& noisy);

}  // namespace earthshine::degrade
