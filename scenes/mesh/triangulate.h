// SPDX-License-Identifier: Apache-2.0
// Triangulates polygons and conserves their area. In radiosity area is power: a triangulation of a
// concave polygon's hull would add light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/units.h"

namespace earthshine::scenes {

enum class PolygonKind { Sound, Degenerate, Crossing };

// Corner indices of the triangles, in the polygon's winding. Triangles without area are omitted. A
// quadrilateral that is convex in projection along its normal, flat or not, gives (0,1,2), (0,2,3).
struct Triangulation {
  PolygonKind kind = PolygonKind::Degenerate;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double area = 0.0;           // of the polygon's projection along the normal
  double triangle_area = 0.0;  // sum over the triangles; larger if the polygon is not flat
};

// Half the sum of the cross products of the edges: normal times area for a flat polygon (Newell).
[[nodiscard]] Vec3 vector_area(std::span<const Vec3> corners);

// Ear clipping in the plane of Newell's normal, O(n^2). Degenerate: area below smallest_area, or
// fewer than three different consecutive corners. Crossing: the projected triangles do not add up
// to the polygon's area to 1e-4, so that its outline crosses itself. A quadrilateral that is so
// twisted that only its projection crosses itself is divided by the diagonal of smaller area; if
// equal, into (0,1,2), (0,2,3).
void triangulate(std::span<const Vec3> corners, double smallest_area, Triangulation& result);

}  // namespace earthshine::scenes
