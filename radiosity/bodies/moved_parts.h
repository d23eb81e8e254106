// SPDX-License-Identifier: Apache-2.0
// What moved between two poses of a scene, as boxes around its places then and now: a ray that meets
// none of them has the same hit in both poses.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/bodies/closed_bodies.h"
#include "radiosity/patches/patches.h"
#include "scenes/scene.h"

namespace earthshine::radiosity {

class MovedParts {
 public:
  // then: the vertices in the earlier pose, of the same triangles. bodies: of both poses; those of
  // one of them only count as moved.
  MovedParts(const std::vector<Vec3>& then, const ClosedBodies& bodies_then,
             const scenes::Scene& now, const ClosedBodies& bodies_now);

  // Patches that did not move and lie in no box of a moved body or object: they are covered by the
  // same bodies in both poses. margin_m: around the patch.
  [[nodiscard]] std::vector<char> unmoved(const Patches& patches, double margin_m) const;

  // Whether a ray without end, of unit direction, meets a box.
  [[nodiscard]] bool on_ray(const Vec3& origin, const Vec3& direction) const;
  // Whether a box is within the hull of two balls.
  [[nodiscard]] bool between(const Vec3& a, double radius_a_m, const Vec3& b,
                             double radius_b_m) const;

 private:
  struct Item {
    Vec3 low, high;
  };
  struct Node {
    Vec3 low, high;
    std::uint32_t skip;  // the next node if the box is missed
    bool is_leaf;
  };
  void build(std::vector<Item>& items, std::size_t begin, std::size_t end);
  // Whether the segment from, from + t direction, t in [0, t_max], meets a box widened by radius_m.
  [[nodiscard]] bool meets(const Vec3& from, const Vec3& direction, double t_max,
                           double radius_m) const;

  std::vector<char> moved_;  // per triangle
  std::vector<Node> nodes_;  // in preorder
  std::vector<Item> around_;
  double margin_m_ = 0.0;
  std::size_t most_of_leaf_ = 1;
  bool all_ = false;  // everything may have changed: nothing may be kept
};

}  // namespace earthshine::radiosity
