// SPDX-License-Identifier: Apache-2.0
// Faults of meshes as they come: what can be mended without a guess is mended, and said.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// For a scene whose objects, cameras and lamps have been read; each thing done or found is a
// warning of the scene.
//   Faces that stand twice, alike in material and winding: one is kept.
//   Faces that stand back to back, alike in material but for glass: one is kept, as a sheet whose
//     material is two-sided.
//   Faces on each other that are not alike: named, and left. Where two bodies touch, each hides the
//     other's face: that is no fault.
//   Closed bodies that are turned inside out, or whose faces are wound both ways: turned outward,
//     unless they surround a camera, a lamp or another object (a room), or stand in a body of the
//     same object (a cavity).
//   Open surfaces whose faces are wound both ways: named, and left; Object::orient decides.
// Throws base::Error (Input) for an object all of whose faces stand in another one already.
void mend_surfaces(Scene& scene);

// What is left, for each object of the scene.
struct SurfaceHealth {
  std::size_t parts = 0;         // that hang together by edges
  std::size_t closed_parts = 0;  // of them without open and non-manifold edges
  std::size_t inward_parts = 0;  // of these those that show their backs to the outside
  std::size_t open_edges = 0;
  std::size_t non_manifold_edges = 0;
  std::size_t mixed_edges = 0;  // between faces that are wound against each other
};
[[nodiscard]] std::vector<SurfaceHealth> surface_health(const Scene& scene);

}  // namespace earthshine::scenes
