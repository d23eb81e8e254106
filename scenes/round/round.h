// SPDX-License-Identifier: Apache-2.0
// Round bodies: a mesh cut finer, toward the surface that its normals describe. What comes out is a
// mesh like any other, so that silhouettes, shadows and energy are those of one geometry.
#pragma once

#include <optional>

#include "scenes/mesh.h"

namespace earthshine::scenes {

struct Rounding {
  std::optional<double> crease_deg;  // corners without a normal of the file's: see edge_curves.h
  double turn_deg = 11.25;           // between neighbouring new faces along an edge
};

// Polygons with a curved edge become triangles on cubic patches (curved PN triangles) that meet
// along the curves of edge_curves.h; flat polygons with straight edges stay as they are. Corners
// keep their places, texture coordinates are mixed linearly. Throws base::Error (Input) at `where`
// beyond 2^24 triangles.
[[nodiscard]] Mesh rounded(const Mesh& mesh, const Rounding& rounding, const base::Location& where);

}  // namespace earthshine::scenes
