// SPDX-License-Identifier: Apache-2.0
// Patches of one pose of a scene in another one.
#pragma once

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// The same cells on the triangles of `scene`, which has those of the patches' own scene, some of
// them moved rigidly: areas are equal. Walls that divide cells stay as they were.
[[nodiscard]] Patches posed_patches(Patches patches, const scenes::Scene& scene);

}  // namespace earthshine::radiosity
