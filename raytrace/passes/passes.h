// SPDX-License-Identifier: Apache-2.0
// In which order a picture's rays are cast, and how many: the gather field, then rounds of camera
// samples.
#pragma once

#include <optional>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// What the rays of a picture brought. The sums cover the window and perhaps some pixels around it;
// the field, if there is one, the whole picture.
struct Sampled {
  PixelSums sums;
  std::optional<GatherField> field;
};

// Sets how surfaces are gathered at (`diffuse`, `gather_rays`) in `shared`; fills the report's rays
// and seconds of the gather. All but the options and the report must outlive what is returned.
[[nodiscard]] Sampled sample_picture(ShadingScene& shared, const PathWorld& world,
                                     const CameraModel& camera, const RenderOptions& options,
                                     const Progress& progress, RenderReport& report);

}  // namespace earthshine::raytrace
