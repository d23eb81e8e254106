// SPDX-License-Identifier: Apache-2.0
// What moved between two poses of a scene, as boxes around its places then and now: a ray that
// meets none of them has the same hit in both poses.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/patches/patches.h"
#include "scenes/triangle_point.h"

namespace earthshine::radiosity {

class MovedParts {
 public:
  // then: the vertices in the earlier pose, of the same triangles. bodies: of both poses; those of
  // one of them only count as moved. patches: of this pose; margin_m: around each of them.
  MovedParts(const std::vector<Vec3>& then, const ClosedBodies& bodies_then,
             const scenes::Scene& now, const ClosedBodies& bodies_now, const Patches& patches,
             double margin_m);

  // Whether a patch did not move and lies in no box of a moved body or object: the same bodies
  // cover it in both poses.
  [[nodiscard]] bool is_unmoved(std::size_t patch) const { return unmoved_[patch] != 0; }

  // Whether a ray without end, of unit direction, meets a box.
  [[nodiscard]] bool on_ray(const Vec3& origin, const Vec3& direction) const;
  // Whether a box is within the hull of two balls.
  [[nodiscard]] bool between(const Vec3& a, double radius_a_m, const Vec3& b,
                             double radius_b_m) const;

 private:
  struct Node {
    scenes::Box box;
    std::uint32_t skip;  // the next node if the box is missed
    bool is_leaf;
  };
  void build(std::vector<scenes::Box>& items, std::size_t begin, std::size_t end);
  // Whether the segment from, from + t direction, t in [0, t_max], meets a box widened by radius_m.
  [[nodiscard]] bool meets(const Vec3& from, const Vec3& direction, double t_max,
                           double radius_m) const;

  std::vector<char> unmoved_;  // per patch
  std::vector<Node> nodes_;    // in preorder
  std::size_t most_of_leaf_ = 1;
};

}  // namespace earthshine::radiosity
