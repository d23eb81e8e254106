// SPDX-License-Identifier: Apache-2.0
// Closed convex bodies among a scene's facets, whoever modelled them. From outside, what such a
// body hides is hidden by its faces towards the viewer alone, and is one convex cone about its
// outline.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/exact/polygon/convex_polygon.h"

namespace earthshine::radiosity {

inline constexpr std::uint32_t no_body = 0xFFFFFFFFU;

struct ConvexBody {
  struct Edge {
    Vec3 from, to;
    std::uint32_t left, right;  // faces; the left one is counter-clockwise along the edge
  };
  std::vector<Plane> faces;  // normals outwards
  std::vector<Edge> edges;

  // No point of the polygon is inside the body.
  [[nodiscard]] bool is_outside(const ConvexPolygon& polygon, double margin_m) const;
  // The whole body is in front of the plane.
  [[nodiscard]] bool is_before(const Plane& plane, double margin_m) const;
};

struct ConvexBodies {
  std::vector<std::uint32_t> of_polygon;  // the body it is a face of, or no_body
  std::vector<ConvexBody> bodies;
};

// A body's faces share whole edges with one another, two by two, and look outwards. Corners within
// margin_m are one.
[[nodiscard]] ConvexBodies find_convex_bodies(std::span<const ConvexPolygon> polygons,
                                              double margin_m);

}  // namespace earthshine::radiosity
