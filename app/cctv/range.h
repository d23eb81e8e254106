// SPDX-License-Identifier: Apache-2.0
// The range sensor for `render --range`: one ray per pixel, no light.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "scenes/ray_query.h"
#include "scenes/scene.h"

namespace earthshine::app {

struct RangeShot {
  const scenes::Scene& scene;
  const scenes::RayQuery& query;
  const scenes::Camera& camera;
  std::optional<Size> size;  // overrides the camera's own
};

// Writes the readings of the camera's sensor, or of an ideal one, which is noted on standard error
// unless quiet: channels range (m along the ray, 0: no return) and valid, with the camera and the
// sensor's settings in the header. Each camera of a scene has independent noise. Returns {"camera",
// "columns", "rows", "seconds", "range"}; "range" has the sensor's name, the number of returns, and
// the reasons for missing ones.
Json sense_range(const RangeShot& shot, const std::string& path,
                 const std::vector<std::string>& overrides, const Common& common,
                 StageTimes& times);

}  // namespace earthshine::app
