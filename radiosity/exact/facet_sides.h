// SPDX-License-Identifier: Apache-2.0
// Sides of facets as polygons relative to a local origin, for the exact form factors.
#pragma once

#include <array>
#include <vector>

#include "radiosity/exact/occlusion/convex_bodies.h"
#include "radiosity/exact/occlusion/shadow_clip.h"
#include "radiosity/exact/polygon/convex_polygon.h"
#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

struct Box {
  Vec3 low, high;
  [[nodiscard]] bool meets(const Box& other, double margin_m) const {
    return glm::all(glm::lessThanEqual(low, other.high + margin_m)) &&
           glm::all(glm::lessThanEqual(other.low, high + margin_m));
  }
};
[[nodiscard]] Box box_around(const ConvexPolygon& polygon);

struct Extent {  // in a side's own plane
  double u0, u1, v0, v1;
  [[nodiscard]] bool meets(const Extent& other) const {
    return u0 < other.u1 && other.u0 < u1 && v0 < other.v1 && other.v0 < v1;
  }
};

// The front of a facet, or the back of a sheet.
struct Side {
  std::uint32_t facet = 0;
  std::uint32_t first_patch = 0, patch_count = 0;
  ConvexPolygon polygon;
  Box box;
};

// Gauss points per direction, from 2 to 4; see area_order.
inline constexpr int least_order = 2, most_order = 4;

struct PatchShape {
  ConvexPolygon polygon;
  Ball ball;
  Extent cover;  // in the frame of its side
  std::array<std::uint32_t, most_order - least_order + 2> first_point;
};

// Coordinates are relative to the middle of the scene, so that a scene far from its origin loses no
// further accuracy.
struct FacetSides {
  explicit FacetSides(const Patches& patches);

  Vec3 origin{0.0};                // in the scene
  std::vector<Side> sides;         // ordered by first patch
  std::vector<PatchShape> shapes;  // per patch
  PointColumns points;
  std::vector<ConvexPolygon> blockers;  // per facet
  std::vector<Box> blocker_box;
  std::vector<std::uint32_t> hiding;  // facets that can occlude: not those of the scene's hull
  ConvexBodies bodies;                // of the facets
  double margin_m = 0.0;              // smaller heights are rounding errors

  [[nodiscard]] PointView points_of(const PatchShape& shape, int order) const {
    const auto k = static_cast<std::size_t>(order - least_order);
    return points.view(shape.first_point[k], shape.first_point[k + 1] - shape.first_point[k]);
  }

 private:
  void find_hiding();
};

}  // namespace earthshine::radiosity
