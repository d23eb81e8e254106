// SPDX-License-Identifier: Apache-2.0
// Objects that are too small for single precision at their position.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Ray offsets are bounds of single-precision rounding errors, which grow with the distance from the
// scene's centre of detail (surface_offset.h). Adds a warning that names objects smaller than
// twenty offsets: within 5 % of their size they lack contact light and shadow.
void name_small_objects(Scene& scene);

}  // namespace earthshine::scenes
