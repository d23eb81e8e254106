// SPDX-License-Identifier: Apache-2.0
// The noise of a picture, given its solution, measured by independent looks at some of its pixels.
#pragma once

#include "studies/error_budget.h"
#include "studies/pixel_choice.h"

namespace earthshine::studies {

struct MeasuredNoise {
  Doubt gather, lamps, camera;
  // Of what the picture states of itself (raytrace::Frame::squared_error), as root mean squares:
  // 1 where it is right.
  Doubt correction{1.0, 1.0};
  std::size_t pixels = 0;  // that show a surface and no source
  std::uint64_t rays = 0;
};
[[nodiscard]] MeasuredNoise measure_noise(const StudyScene& scene,
                                          const radiosity::Solution& solution,
                                          const WatchedPicture& picture,
                                          const raytrace::Frame& frame, const SurfacePixels& seen);

// Over those of some pixels that show no source.
struct PixelMeans {
  std::size_t pixels = 0;
  double luminance = 0.0;      // cd/m^2
  double squared_error = 0.0;  // as stated, with error_weight, (cd/m^2)^2
};
[[nodiscard]] PixelMeans pixel_means(const raytrace::Frame& frame, const SurfacePixels& seen,
                                     std::span<const std::uint32_t> pixels);

}  // namespace earthshine::studies
