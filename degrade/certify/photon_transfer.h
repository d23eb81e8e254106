// SPDX-License-Identifier: Apache-2.0
// Photon transfer (EMVA 1288, release 4.0 linear, sections 6 and 8): variance against mean of flat
// fields, with temporal noise separated from the fixed pattern.
//   in time   mean over resels of the variance over L frames
//   in space  variance over resels of the mean of L frames, minus (in time) / L
#pragma once

#include <array>
#include <span>
#include <vector>

#include "degrade/certify/block_statistics.h"

namespace earthshine::degrade {

// One flat field. The vectors have one value per block and plane, in the same order for all levels.
struct FlatField {
  double signal = 0.0;  // signal of the chart
  std::vector<double> mean, in_time, in_space;
};
// frames: at least two, of the same size.
[[nodiscard]] FlatField measure_flat(double signal, std::span<const Picture> frames,
                                     const std::vector<Block>& blocks);

// in time = a + b S + c S^2, in space = fixed_a + fixed_c S^2. Least squares with weights
// 1 / variance^2, because the error of a sample variance is proportional to the variance. Each
// block is fitted separately with the common weights; the scatter of the fits gives the errors.
struct PhotonTransfer {
  Estimate a, b, c;
  Estimate fixed_a, fixed_c;
};
// Needs at least three different signals.
[[nodiscard]] PhotonTransfer fit_photon_transfer(std::span<const FlatField> fields);

}  // namespace earthshine::degrade
