// SPDX-License-Identifier: Apache-2.0
// The parts of each patch that no body covers (closed_bodies.h), as polygons: form factors are
// integrals over them.
//
// A patch is cut along every line in which another face meets or crosses its plane. Bodies are
// bounded by faces, so that each part is covered wholly or not at all, and one point decides.
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
  std::vector<std::uint32_t> near;   // what may cover points of the patch; empty: nothing
  std::vector<ConvexPolygon> parts;  // not covered, about FacetSides::origin; empty: all or none
  double open = 1.0;                 // share of the patch's area
  double std_error = 0.0;            // of `open`: half of what lies in parts whose points disagree

  [[nodiscard]] bool is_whole() const { return open == 1.0; }
};

// Per patch.
[[nodiscard]] std::vector<PatchCover> find_open_parts(const ClosedBodies& bodies,
                                                      const scenes::RayQuery& query,
                                                      const Patches& patches,
                                                      const FacetSides& sides);

}  // namespace earthshine::radiosity
