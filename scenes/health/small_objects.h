// SPDX-License-Identifier: Apache-2.0
// Objects that single precision loses in a scene as wide as it is.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Names objects that are smaller than twenty times what rays are lifted off surfaces (ray_query.h),
// as a warning of the scene: at least a twentieth of their size about them is without their light
// and shadow. The object without which the scene is half as wide at most, if there is one such, is
// named with them: often it is out of place, or at another scale than the rest.
void name_small_objects(Scene& scene);

}  // namespace earthshine::scenes
