// SPDX-License-Identifier: Apache-2.0
// In which order a picture's rays are cast, and how many: the gather field, then rounds of camera
// samples.
#pragma once

#include "raytrace/pixel_sums.h"

namespace earthshine::raytrace {

// Throws base::Error (Input) if the crop leaves the picture.
[[nodiscard]] Window window_of(const RenderOptions& options);

// The sums cover the window and some pixels around it. Sets how surfaces are gathered at
// (`diffuse`, `gather_rays`) in `shared`; fills the report's rays and seconds of the gather.
[[nodiscard]] PixelSums sample_picture(ShadingScene& shared, const CameraModel& camera,
                                       const RenderOptions& options, const Progress& progress,
                                       RenderReport& report);

}  // namespace earthshine::raytrace
