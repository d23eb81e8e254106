// SPDX-License-Identifier: Apache-2.0
// Offset of rays that leave a patch.
#pragma once

#include <cstdint>

#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// m; for several triangles the maximum (scenes/surface_offset.h).
[[nodiscard]] double patch_offset_m(const Patches& patches, const scenes::RayQuery& query,
                                    std::uint32_t patch);

// Start of a ray that leaves a point of a patch.
[[nodiscard]] inline Vec3 lifted(const SurfacePoint& from, const scenes::RayQuery& query) {
  return from.position + query.offset_m(from.triangle) * from.normal;
}

}  // namespace earthshine::radiosity
