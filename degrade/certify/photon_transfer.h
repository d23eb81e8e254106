// SPDX-License-Identifier: Apache-2.0
// Photon transfer (EMVA 1288, release 4.0 linear, sections 6 and 8): variance against mean of flat
// fields, the noise that changes from frame to frame told from the pattern that does not.
//   in time   mean over resels of the variance over L frames
//   in space  variance over resels of the mean of L frames, less (in time) / L
#pragma once

#include <array>
#include <span>
#include <vector>

#include "degrade/certify/block_statistics.h"

namespace earthshine::degrade {

// One flat field. The vectors have a number for each block of each plane, in the same order for all
// levels.
struct FlatField {
  double signal = 0.0;  // the light that was given
  std::vector<double> mean, in_time, in_space;
};
// frames: at least two, of the same size.
[[nodiscard]] FlatField measure_flat(double signal, std::span<const Picture> frames,
                                     const std::vector<Block>& blocks);

// in time = a + b S + c S^2, in space = fixed_a + fixed_c S^2: least squares with weights 1 /
// variance^2, because a sample variance scatters in proportion to the variance. Each block is
// fitted by itself with the weights of all; the scatter of the fits gives the errors.
struct PhotonTransfer {
  Estimate a, b, c;
  Estimate fixed_a, fixed_c;
};
// At least three different signals.
[[nodiscard]] PhotonTransfer fit_photon_transfer(std::span<const FlatField> fields);

}  // namespace earthshine::degrade
