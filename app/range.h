// SPDX-License-Identifier: Apache-2.0
// The range sensor as `render --range` uses it: one ray per pixel, no light.
#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "scenes/scene.h"

namespace earthshine::app {

// Writes what the sensor that `camera` of the scene names reports, or one without faults, which is
// said on standard error unless quiet: channels range (m along the ray, 0: no return) and valid,
// the camera and the sensor's settings in the header. Each camera of a scene has noise of its own.
// Returns the sensor's name, how many pixels returned, and why the others did not.
Json sense_range(const std::string& path, const scenes::Scene& scene,
                 const std::vector<std::string>& overrides, const scenes::Camera& camera,
                 const Size& size, const Common& common);

}  // namespace earthshine::app
