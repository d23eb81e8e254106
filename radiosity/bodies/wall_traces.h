// SPDX-License-Identifier: Apache-2.0
// Lines in which walls stand on facets or pierce them.
#pragma once

#include "radiosity/patches/parted_cell.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

// Traces of opaque triangles that meet a facet's plane within the facet, to within the contact
// distance (SurfaceOffsets::contact), and extend beyond it on a side with patches. Traces along the
// facet's edge, and clusters of small triangles, are omitted. Collinear pieces are joined.
[[nodiscard]] Traces find_wall_traces(const scenes::Scene& scene, const Patches& patches);

}  // namespace earthshine::radiosity
