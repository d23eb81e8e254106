// SPDX-License-Identifier: Apache-2.0
// The analytic twin of a noisy picture: what it is without noise, what it is on average, and the
// variance of every pixel, all without drawing a number; and what that means for seeing a target.
#pragma once

#include "degrade/chain.h"
#include "degrade/detection.h"

namespace earthshine::degrade {

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
