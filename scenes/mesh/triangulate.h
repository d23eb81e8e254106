// SPDX-License-Identifier: Apache-2.0
// Polygons to triangles with conserved area. In radiosity area is power: a triangulation that
// covers a concave polygon's hull instead of the polygon would give it light that it does not have.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/units.h"

namespace earthshine::scenes {

enum class PolygonKind { Sound, Degenerate, Crossing };

// Corner numbers of the triangles, in the polygon's own sense of rotation. Triangles without area
// are left out. A quadrilateral that is convex seen along its normal, flat or not, gives (0,1,2),
// (0,2,3).
struct Triangulation {
  PolygonKind kind = PolygonKind::Degenerate;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double area = 0.0;           // of the vector area (Newell): the polygon seen along its normal
  double triangle_area = 0.0;  // sum over the triangles; larger where the polygon is not flat
};

// Half the sum of the cross products of the edges: normal times area for a flat polygon (Newell).
[[nodiscard]] Vec3 vector_area(std::span<const Vec3> corners);

// Ear clipping in the plane of Newell's normal, O(n^2). Degenerate: less area than smallest_area,
// or fewer than three different corners in a row. Crossing: the triangles, seen along the normal,
// do not add up to the polygon's area to 1e-4, so its outline crosses itself. A quadrilateral so
// twisted that it crosses itself only as seen along the normal is cut by the diagonal that leaves
// the smaller area, by (0,1,2), (0,2,3) where both leave the same.
void triangulate(std::span<const Vec3> corners, double smallest_area, Triangulation& result);

}  // namespace earthshine::scenes
