// SPDX-License-Identifier: Apache-2.0
// Faults of meshes as they come: what can be mended without a guess is mended, and said.
#pragma once

#include "base/units.h"
#include "scenes/health/coincident.h"
#include "scenes/health/file_fronts.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// For a scene whose objects, cameras and lamps have been read; each thing done or found is a
// warning of the scene. Objects with Orient::AsIs are left alone, without a word.
//   Faces that stand twice, alike in material and winding: one is kept.
//   Faces of one object that stand back to back, alike in material but for glass: one is kept, as a
//     sheet whose material is two-sided.
//   Other faces exactly on each other are left (coincident.h); where one is glass they are named.
//   Closed bodies that are turned inside out, or whose faces are wound both ways: turned outward.
//     Not those that have a camera, a lamp or a surface in them, a window or a shining face (rooms;
//     around a camera faces wound both ways are turned inward, else to the side of most of the
//     area), nor those that stand in a body of the same object (cavities).
//   Open surfaces whose file has vertex normals (fronts), nearly all on one side: that is the front.
//     The same of rooms. Not of other bodies: their front is outside.
//   Other open surfaces whose faces are wound both ways, and surfaces without two sides: named, and left,
//     unless all of them is two-sided; Object::orient decides.
// Throws base::Error (Input) for an object all of whose faces stand, turned alike, in objects
// before it. Fills Object::surface and gives the parts of what there is then.
FaceParts mend_surfaces(Scene& scene, const FileFronts& fronts);

// Lamps that stand on a surface, or nearer to it than rays can tell.

// Moves each lamp that rays in single precision would not find in front of a surface (eight
// contact's lengths, 0.16 mm of faces of 2 m and more) to where they do, with a warning: half of its light lands there all the same. A
// lamp on a surface is taken to be in front of it, in a corner in front of all that meet there; one
// between sheets that are nearer still stays, and is named. Of lamps with a size the centre counts;
// those that shine away from the surface, as flush ones do, come forward by as much without a word.
void lift_lamps(Scene& scene);

}  // namespace earthshine::scenes
