// SPDX-License-Identifier: Apache-2.0
// Lamps that stand on a surface, or nearer to it than rays can tell.
#pragma once

#include "base/units.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// Moves each lamp that rays in single precision would not find in front of a surface (1.6e-5 of the
// surfaces' extent) to where they do, with a warning: half of its light lands there all the same. A
// lamp on a surface is taken to be in front of it, in a corner in front of all that meet there; one
// between sheets that are nearer still stays, and is named. Of lamps with a size the centre counts,
// and those that shine away from the surface stay.
void lift_lamps(Scene& scene);

}  // namespace earthshine::scenes
