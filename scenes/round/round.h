// SPDX-License-Identifier: Apache-2.0
// Round bodies: refines a mesh toward the surface that its normals describe. The result is an
// ordinary mesh, so that silhouettes, shadows and energy use the same geometry.
#pragma once

#include <optional>

#include "scenes/mesh.h"

namespace earthshine::scenes {

struct Rounding {
  std::optional<double> crease_deg;  // for corners without a normal in the file: see edge_curves.h
  double step_deg = 11.25;           // between neighbouring new faces along an edge
};

// Polygons with a curved edge become triangles on cubic patches (curved PN triangles) that meet
// along the curves of edge_curves.h. Flat polygons with straight edges are unchanged. Corners keep
// their positions; texture coordinates are interpolated linearly. Throws base::Error (Input) at
// `where` above 2^24 triangles.
[[nodiscard]] Mesh rounded(const Mesh& mesh, const Rounding& rounding, const base::Location& where);

}  // namespace earthshine::scenes
