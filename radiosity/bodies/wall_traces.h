// SPDX-License-Identifier: Apache-2.0
// Where walls stand on facets or pierce them.
#pragma once

#include "radiosity/patches/parted_cell.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

// Of opaque triangles that meet the plane of a facet within it, nearer to it than rays are lifted
// off surfaces (SurfaceOffsets::contact), and reach beyond it on a side that has patches. What
// only runs along the facet's edge is left out, as are clusters of small triangles. Pieces of one
// line are joined.
[[nodiscard]] Traces find_wall_traces(const scenes::Scene& scene, const Patches& patches);

}  // namespace earthshine::radiosity
