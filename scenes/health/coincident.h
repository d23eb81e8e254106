// SPDX-License-Identifier: Apache-2.0
// Order of overlapping coplanar faces.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Connected parts of the surfaces (topology.h).
struct FaceParts {
  enum class Kind : std::uint8_t { Open, Body, Room };  // closed: seen from outside, from inside
  std::vector<std::uint32_t> of;                        // part of each triangle
  std::vector<Kind> kind;                               // per part
};

// For instances, which follow all other objects: copies the parts of their originals.
void add_instances(FaceParts& parts, const Scene& scene);

// Fills scene.coincident with pairs of triangles of two parts, one opaque and the other without
// holes, that are nearer than the contact distance (SurfaceOffsets::contact) and overlap by more
// than it. An opaque face hides glass, from both sides: a ray continuing from the glass would start
// beyond the opaque face. An opaque face that is in front by a fiftieth of the contact distance or
// more hides the other. Otherwise
//   a body's face and another face toward it hide each other, unless the other's part is within
//   the body's box: the walls of a house;
//   other one-sided faces with opposite normals are the two sides of a sheet: both are visible;
//   among faces with equal normals, and two-sided ones, an emitter is in front of other faces, an
//   open surface in front of rooms' walls, and these in front of bodies; else the later face of the
//   scene is in front.
// scene.warnings names open faces of two materials ordered only by the scene, and the two sides of
// a sheet, except for objects with Orient::AsIs. Interpenetrating bodies give no warning: most of
// their coplanar faces are inside one of them. A warning also names gaps and steps between faces
// that are narrower than twenty ray offsets, if the offsets exceed 10 um.
void find_coincident_faces(Scene& scene, const FaceParts& parts);

// Again, after objects have moved; without warnings. Needs scene.face_parts. is_moved: of each
// object; pairs of two others stay.
void find_coincident_faces_again(Scene& scene, const std::vector<bool>& is_moved);

}  // namespace earthshine::scenes
