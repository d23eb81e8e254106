// SPDX-License-Identifier: Apache-2.0
// Faces in one plane that overlap: which of them is over which.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// The parts that the surfaces hang together in (topology.h).
struct FaceParts {
  enum class Kind : std::uint8_t { Open, Body, Room };  // closed: seen from outside, from inside
  std::vector<std::uint32_t> of;                        // per triangle its part
  std::vector<Kind> kind;                               // per part
};

// Of instances, which stand after all other objects: as the parts of their originals.
void add_instances(FaceParts& parts, const Scene& scene);

// Fills scene.coincident: triangles of two parts, one of them opaque and the other without holes,
// that overlap by more than a contact's length (SurfaceOffsets::contact) and are nearer to each
// other than that. Of glass and what is opaque this one is met, from both sides: a
// ray that went on from the glass would begin beyond it. Of two that are opaque, where one is
// before the other by a fiftieth of that or more, so it is seen. Otherwise
//   a body's face and another that look at each other hide each other, unless the other's part is
//   within the body's box: the walls of a house;
//   other one-sided faces that look opposite ways are the two sides of a sheet: each is seen;
//   of those that look the same way, and of two-sided ones, what shines is before what does not,
//   what is open before rooms' walls, and these before bodies, and the later one of the scene
//   before the earlier.
// What only the order of the scene decided, of open faces of two materials, is named in
// scene.warnings, as are two sides of a sheet; but not of objects with Orient::AsIs. Of bodies that
// stick in each other nothing is said: most of their faces in one plane are in one of them.
// Gaps and steps between faces that are narrower than twenty offsets of rays are named, too, where
// these are more than 10 um.
void find_coincident_faces(Scene& scene, const FaceParts& parts);

}  // namespace earthshine::scenes
