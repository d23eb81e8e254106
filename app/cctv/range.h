// SPDX-License-Identifier: Apache-2.0
// The range sensor as `render --range` uses it: one ray per pixel, no light.
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
  std::optional<Size> size;  // unless the camera's own
};

// Writes what the sensor that the camera names reports, or one without faults, which is said on
// standard error unless quiet: channels range (m along the ray, 0: no return) and valid, the camera
// and the sensor's settings in the header. Each camera of a scene has noise of its own. Returns
// {"camera", "columns", "rows", "seconds", "range"}, the last with the sensor's name, how many
// pixels returned, and why the others did not.
Json sense_range(const RangeShot& shot, const std::string& path,
                 const std::vector<std::string>& overrides, const Common& common,
                 StageTimes& times);

}  // namespace earthshine::app
