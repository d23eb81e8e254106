// SPDX-License-Identifier: Apache-2.0
// Repairs faults of meshes that have a unique remedy, and reports each repair.
#pragma once

#include "base/units.h"
#include "scenes/health/coincident.h"
#include "scenes/health/file_fronts.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

// For a scene whose objects, cameras and lamps have been read. Each repair or fault gives a warning
// of the scene. Objects with Orient::AsIs are left unchanged without a warning.
//   Duplicate faces with equal material and winding: one is kept.
//   Faces of one object back to back with equal material, except glass: one is kept, as a
//     sheet with a two-sided material.
//   Other coincident faces are kept (coincident.h); glass among them is named.
//   Closed bodies that are inside out, or have mixed winding: oriented outward. Excluded are rooms:
//     bodies that contain a camera, a lamp or a surface, or have a window or an emitting face (with
//     mixed winding, rooms around a camera are oriented inward, others to the side of most of the
//     area), and cavities: bodies inside a body of the same object.
//   Open surfaces, and rooms, whose file has vertex normals nearly all on one side: that side
//     is the front. Other bodies have their front outside.
//   Other open surfaces with mixed winding, and surfaces with one side only (Moebius strips): named
//     and kept, unless completely two-sided; Object::orient decides.
// Throws base::Error (Input) for an object all of whose faces duplicate faces of earlier objects
// with equal winding. Fills Object::surface and returns the parts after the repairs.
FaceParts mend_surfaces(Scene& scene, const FileFronts& fronts);

// Lamps on a surface, or nearer to it than ray accuracy.

// Moves each lamp that single-precision rays would not find in front of a surface, with a warning:
// without this half of its light would be lost. The new distance is eight contact distances, 0.16
// mm for faces of 2 m and more. A lamp on a surface is assumed to be in front of it, in a corner in
// front of all its surfaces. A lamp between sheets that are closer stays and is named. For extended
// lamps the centre counts; flush lamps, which shine away from the surface, are moved by the same
// distance without a warning.
void lift_lamps(Scene& scene);

}  // namespace earthshine::scenes
