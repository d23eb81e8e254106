// SPDX-License-Identifier: Apache-2.0
// How the chain's stages change the first two moments of a picture with noise: the analytic twin's
// side of the table in stages.cpp. Linear stages are exact. Point by point maps are exact for each
// pixel's own mean and variance as far as its noise is Gaussian, and of second order for the
// covariance of neighbours.
#pragma once

#include <vector>

#include "degrade/chain.h"
#include "degrade/moments/noise_moments.h"
#include "degrade/stage/point_map.h"

namespace earthshine::degrade {

struct Moments {
  Picture mean;
  std::vector<Covariance> grain;    // of each plane: other in every frame
  std::vector<Covariance> pattern;  // of each plane: the same in every frame
  // Maps point by point that are still to come, so that all of them in a row are one map.
  PointMap pending;
  bool is_pending = false;
};

// A picture without noise.
[[nodiscard]] Moments still(Picture picture);
// With the pending map carried out.
[[nodiscard]] Moments settled(Moments moments);
// Variance of one plane, of all its noise.
[[nodiscard]] Plane variance(const Moments& moments, std::size_t plane);

// What the stage makes of them.
[[nodiscard]] Moments carry(Moments moments, const Stage& stage, const StageContext& at);

// Of the stages whose law is of a whole picture; each is the twin of the stage of its name.
[[nodiscard]] Moments carry_signal_noise(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_lag(Moments moments, const StageContext& at);
// The noise of the halo itself is left out: spread over a Gaussian of many resels it is below 1 /
// (4 pi radius^2) of the excess' own.
[[nodiscard]] Moments carry_bloom(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_saturation(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_read_noise(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_interlace(Moments moments, const StageContext& at);
// Light below zero, which a sinc makes, is not cut here.
[[nodiscard]] Moments carry_spread(Moments moments, const StageContext& at);
[[nodiscard]] Moments carry_room_light(Moments moments, const StageContext& at);

}  // namespace earthshine::degrade
