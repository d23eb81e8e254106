// SPDX-License-Identifier: Apache-2.0
// The open parts of each patch, which no body covers (closed_bodies.h), as polygons: form factors
// are integrals over them.
//
// A patch is cut along every line in which another face meets its plane. Faces bound bodies, so
// that each part is completely covered or completely open; one point decides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/exact/facet_sides.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

struct PatchCover {
  std::vector<std::uint32_t> near;   // possible covers; empty: none
  std::vector<ConvexPolygon> parts;  // relative to FacetSides::origin; empty: all or none is open
  double open = 1.0;                 // share of the patch's area
  double std_error = 0.0;            // half the area of parts with contradictory points

  [[nodiscard]] bool is_whole() const { return open == 1.0; }
};

// One result per patch.
[[nodiscard]] std::vector<PatchCover> find_open_parts(const ClosedBodies& bodies,
                                                      const scenes::RayQuery& query,
                                                      const Patches& patches,
                                                      const FacetSides& sides);

}  // namespace earthshine::radiosity
