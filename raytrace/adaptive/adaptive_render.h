// SPDX-License-Identifier: Apache-2.0
// The loop that draws a picture: initial samples, then rounds of denoising, error statement,
// allocation and further samples.
#pragma once

#include <optional>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// The samples of a picture: the sums of the window's pixels; the gather points of the whole
// picture, if there are any.
struct Sampled {
  PixelSums sums;
  std::optional<GatherField> field;
};

// Sets `field` in `shared`; fills the report's rays and the seconds at gather points. All but the
// options and the report must outlive what is returned.
[[nodiscard]] Sampled sample_picture(ShadingScene& shared, const PathWorld& world,
                                     const CameraModel& camera, const RenderOptions& options,
                                     const Progress& progress, RenderReport& report);

}  // namespace earthshine::raytrace
