// SPDX-License-Identifier: Apache-2.0
// The loop that draws a picture: initial samples, then rounds of denoising, error statement,
// allocation and further samples.
#pragma once

#include <optional>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// The samples of a picture: sums over the pixels of the window, and the gather points of the whole
// picture, if there are any.
struct Sampled {
  PixelSums sums;
  std::optional<GatherField> field;
};

// Sets `field` in `shared`, and the rays and the seconds at gather points in the report. All
// arguments but the options and the report must outlive the result.
[[nodiscard]] Sampled sample_picture(ShadingScene& shared, const PathWorld& world,
                                     const CameraModel& camera, const RenderOptions& options,
                                     const Progress& progress, RenderReport& report);

}  // namespace earthshine::raytrace
