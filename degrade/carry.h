// SPDX-License-Identifier: Apache-2.0
// Propagates the first two moments of a noisy picture through the stages of the chain, for the
// analytic twin. Linear stages are exact. Point maps are exact for the mean and variance of a pixel
// if its noise is Gaussian, and of second order for the covariance of neighbours.
#pragma once

#include <vector>

#include "degrade/chain.h"
#include "degrade/moments/noise_moments.h"
#include "degrade/stage/point_map.h"

namespace earthshine::degrade {

struct Moments {
  Picture mean;
  std::vector<Covariance> grain;    // of each plane: new in every frame
  std::vector<Covariance> pattern;  // of each plane: the same in every frame
  // Point maps that are not applied yet, so that consecutive maps are applied as one.
  PointMap pending;
  bool is_pending = false;
};

// A picture without noise.
[[nodiscard]] Moments still(Picture picture);
// Applies the pending map.
[[nodiscard]] Moments settled(Moments moments);
// Variance of all noise of one plane.
[[nodiscard]] Plane variance(const Moments& moments, std::size_t plane);

// Propagates the moments through a stage.
[[nodiscard]] Moments carry(Moments moments, const Stage& stage, const StageContext& at);

// Stages with a law of the whole picture; each function is the twin of the stage of its name.
[[nodiscard]] Moments carry_signal_noise(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_lag(Moments moments, const StageContext& at);
// Neglects the noise of the halo: a Gaussian over many resels reduces it below 1 / (4 pi radius^2)
// of the noise of the excess.
[[nodiscard]] Moments carry_bloom(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_saturation(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_read_noise(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_interlace(Moments moments, const StageContext& at);
// Does not clip negative light, which a sinc spread produces.
[[nodiscard]] Moments carry_spread(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_room_light(Moments moments, const StageContext& at);

}  // namespace earthshine::degrade
