// SPDX-License-Identifier: Apache-2.0
// A picture at once: the radiance of the solution's patches where each pixel's centre looks, with
// mirrors, glass and sky. Direct light is as coarse as the patches, and highlights and lamps are
// missing: for a camera that is being moved, before render().
#pragma once

#include "base/image.h"
#include "radiosity/solution.h"
#include "raytrace/camera/camera.h"
#include "scenes/effects/world.h"

namespace earthshine::raytrace {

// R, G, B in cd/m^2.
[[nodiscard]] base::Image preview(const scenes::World& world, const radiosity::Solution& solution,
                                  const CameraModel& camera);

}  // namespace earthshine::raytrace
