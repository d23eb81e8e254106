// SPDX-License-Identifier: Apache-2.0
// Normals of the surface that a mesh stands for, at the corners of its polygons.
#pragma once

#include <optional>
#include <vector>

#include "scenes/mesh.h"

namespace earthshine::scenes {

// One for each of mesh.indices, of unit length, on its polygon's side: the file's own where it has
// one; else, with crease_deg, the mean of the normals of the polygons around the corner's place
// that are turned less than that against its own, by area; else its polygon's. ids: of the
// vertices, equal at one place (health/topology.h).
[[nodiscard]] std::vector<Vec3> corner_normals(const Mesh& mesh,
                                               const std::vector<std::uint32_t>& ids,
                                               std::optional<double> crease_deg);

}  // namespace earthshine::scenes
