// SPDX-License-Identifier: Apache-2.0
// Detects closed convex bodies among a scene's facets. From outside, such a body occludes with the
// faces toward the viewer only: its shadow is one convex cone through its outline.
#pragma once

#include <array>
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

  // Whether the whole body is in front of the plane.
  [[nodiscard]] bool is_before(const Plane& plane, double margin_m) const;
};

struct ConvexBodies {
  std::vector<std::uint32_t> of_polygon;  // the body it is a face of, or no_body
  std::vector<ConvexBody> bodies;
};

// The faces of a body share whole edges pairwise and have outward normals. Corners within margin_m
// are merged.
[[nodiscard]] ConvexBodies find_convex_bodies(std::span<const ConvexPolygon> polygons,
                                              double margin_m);

// The convex hull of two polygons, as planes: space of possible occluders (shaft).

// The polygons must be in front of each other (heights >= 0 up to margin_m).
class Shaft {
 public:
  Shaft(const ConvexPolygon& first, const ConvexPolygon& second, double margin_m);

  // False if nothing of the blocker is between the two polygons; conservative.
  [[nodiscard]] bool may_hide(const ConvexPolygon& blocker) const;

 private:
  void add_planes(const ConvexPolygon& from, const ConvexPolygon& to);

  std::array<Plane, static_cast<std::size_t>(2 * ConvexPolygon::most_corners)> outside_{};
  std::size_t count_ = 0;
  Vec3 low_, high_;
  double margin_m_;
};

}  // namespace earthshine::radiosity
