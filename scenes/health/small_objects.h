// SPDX-License-Identifier: Apache-2.0
// Objects that are too small for single precision where they are.
#pragma once

#include "scenes/scene.h"

namespace earthshine::scenes {

// Rays start off surfaces by the rounding errors of single precision, which grow with the distance
// from the scene's centre of detail (surface_offset.h). Names, as a warning of the scene, objects that
// are smaller than twenty such offsets: 5 % of their size about them have neither their light nor
// their shadow.
void name_small_objects(Scene& scene);

}  // namespace earthshine::scenes
