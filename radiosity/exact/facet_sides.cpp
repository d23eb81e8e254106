// SPDX-License-Identifier: Apache-2.0
#include "radiosity/exact/facet_sides.h"

#include <algorithm>
#include <limits>

namespace earthshine::radiosity {
namespace {

constexpr Rectangle whole_facet{0.0, 1.0, 0.0, 1.0};

// Part of a facet, counter-clockwise about its front, relative to a nearby origin: the corners of
// Patches::corners would lose digits far from the scene's origin.
std::array<Vec3, 4> corners(const Facet& facet, const Vec3& origin, const Rectangle& part) {
  const Vec3 corner = facet.corner - origin;
  const auto at = [&](double s, double t) {
    return facet.parallelogram ? corner + s * facet.a + t * facet.b
                               : corner + s * (facet.a + t * (facet.b - facet.a));
  };
  return {at(part.s0, part.t0), at(part.s1, part.t0), at(part.s1, part.t1), at(part.s0, part.t1)};
}

ConvexPolygon side_polygon(std::array<Vec3, 4> corner, const Facet& facet, bool back) {
  if (back) std::reverse(corner.begin(), corner.end());
  return make_polygon(corner, back ? -facet.normal : facet.normal);
}

}  // namespace

Box box_around(const ConvexPolygon& polygon) {
  Box box{polygon[0], polygon[0]};
  for (int k = 1; k < polygon.count; ++k) {
    box.low = glm::min(box.low, polygon[k]);
    box.high = glm::max(box.high, polygon[k]);
  }
  return box;
}

FacetSides::FacetSides(const Patches& patches) {
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Facet& facet : patches.facets) {
    for (const Vec3& p : corners(facet, Vec3(0.0), whole_facet)) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  origin = 0.5 * (low + high);
  const double largest = base::max_component(glm::max(glm::abs(low), glm::abs(high)));
  margin_m =
      1e-12 * glm::length(high - low) + 4.0 * std::numeric_limits<double>::epsilon() * largest;

  shapes.resize(patches.count());
  for (std::uint32_t f = 0; f < patches.facets.size(); ++f) {
    const Facet& facet = patches.facets[f];
    const auto whole = corners(facet, origin, whole_facet);
    blockers.push_back(side_polygon(whole, facet, false));
    blocker_box.push_back(box_around(blockers.back()));
    for (const bool back : {false, true}) {
      const std::uint32_t first = back ? facet.first_back : facet.first_front;
      if (first == no_patch) continue;
      Side side{f, first, facet.leaves, side_polygon(whole, facet, back), blocker_box.back()};
      const TargetFrame frame(side.polygon);
      for (std::uint32_t c = 0; c < side.patch_count; ++c) {
        PatchShape& shape = shapes[first + c];
        shape.polygon =
            side_polygon(corners(facet, origin, patches.rectangle(first + c)), facet, back);
        shape.ball = ball_around(shape.polygon);
        const Box cover = box_around(frame.polygon(shape.polygon));
        shape.cover = {cover.low.x, cover.high.x, cover.low.y, cover.high.y};
        for (int order = least_order; order <= most_order; ++order) {
          shape.first_point[static_cast<std::size_t>(order - least_order)] =
              static_cast<std::uint32_t>(points.add(shape.polygon, order));
        }
        shape.first_point.back() = static_cast<std::uint32_t>(points.count());
      }
      sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.first_patch < b.first_patch; });
  find_hiding();
  bodies = find_convex_bodies(blockers, margin_m);
}

void FacetSides::find_hiding() {
  for (std::uint32_t f = 0; f < blockers.size(); ++f) {
    // A facet with the whole scene on one side is part of its hull and occludes nothing.
    const Plane plane{blockers[f][0], blockers[f].normal};
    bool above = false, below = false;
    for (std::size_t g = 0; g < blockers.size() && !(above && below); ++g) {
      for (int k = 0; k < blockers[g].count; ++k) {
        const double height = plane.height(blockers[g][k]);
        above = above || height > margin_m;
        below = below || height < -margin_m;
      }
    }
    if (above && below) hiding.push_back(f);
  }
}

}  // namespace earthshine::radiosity
