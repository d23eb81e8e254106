// SPDX-License-Identifier: Apache-2.0
// A look ahead, to plan a picture's rays.
#pragma once

#include <functional>
#include <vector>

#include "raytrace/shade/pixel_sums.h"

namespace earthshine::raytrace {

// What a coarse look at the whole picture tells, read from the solution: the mean luminance of what
// is lit, and the mean deviation of a camera sample from its pixel. Sources that the camera sees
// themselves are left out of the former.
struct PilotPass {
  double luminance = 0.0, deviation = 0.0;
  std::vector<double> dimmest;  // ShadingScene::dimmest
  RayCounts rays;               // that it took
  // From here on pixels count as bright (PixelSums::deviation).
  [[nodiscard]] double bright() const { return 4.0 * luminance; }
};

// samples: camera samples per pixel that is looked at. The same for every crop of a picture, but
// where stop() leaves pixels out.
[[nodiscard]] PilotPass run_pilot_pass(ShadingScene shared, const CameraModel& camera, int samples,
                                       const std::function<bool()>& stop);

}  // namespace earthshine::raytrace
