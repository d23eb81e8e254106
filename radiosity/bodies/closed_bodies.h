// SPDX-License-Identifier: Apache-2.0
// Bodies that cover parts of other objects: the floor under a box, the part of a strut inside a
// wall. Such points neither receive nor send light.
//
// A body is a closed surface of opaque one-sided faces with outward normals: triangles connected by
// edges (exactly equal vertices), every edge used equally often in both directions. The winding
// number of such a surface about a point is an integer in every direction: 1 inside, 0 outside. A
// room that is seen from inside (faces inward, winding -1) covers nothing and uncovers its volume
// of a body around it (a house: walls inside an outer shell). If all light sources are in such
// rooms, everything outside the rooms is covered too: the foot of a box on or in a floor receives
// and sends nothing below the floor. A hole that rests on another surface all around counts as
// closed (closed_parts.h). Sheets, glass, other open meshes and meshes with mixed winding cover
// nothing, because their inside is undefined. Faces with other faces on them
// (scenes/health/coincident.h) and the holes of opacity masks count as covered.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/patches/patches.h"
#include "scenes/coincident_faces.h"
#include "scenes/scene.h"
#include "scenes/surface_texture.h"

namespace earthshine::radiosity {

// Tolerance as a share of the scene's extent; single-precision errors of rays are 1e-7.
inline constexpr double body_rounding = 1e-5;

// A closed surface, projected along its shortest side. Its winding number about a point is the sum
// of the projected winding numbers, +1, 0 or -1, of its triangles beyond the point. Each edge is
// evaluated identically for both of its triangles, so that no point falls between them.
class ClosedSurface {
 public:
  // corners: three per triangle.
  explicit ClosedSurface(std::span<const Vec3> corners);

  [[nodiscard]] int winding(const Vec3& point) const;
  [[nodiscard]] bool may_wind(const Vec3& low, const Vec3& high) const {
    return glm::all(glm::lessThanEqual(low, high_)) && glm::all(glm::lessThanEqual(low_, high));
  }
  [[nodiscard]] bool lies_in_box_of(const ClosedSurface& other) const {
    return glm::all(glm::greaterThanEqual(low_, other.low_)) &&
           glm::all(glm::lessThanEqual(high_, other.high_));
  }
  // Whether it is made of these corners.
  [[nodiscard]] bool is_of(std::span<const Vec3> corners) const;
  [[nodiscard]] scenes::Box box() const { return {low_, high_}; }
  [[nodiscard]] double volume_m3() const { return volume_m3_; }  // positive if oriented outward
  [[nodiscard]] double box_m3() const {
    const Vec3 size = high_ - low_;
    return size.x * size.y * size.z;
  }

 private:
  struct Corners {
    Vec3 a, b, c;
  };
  // Makes the projection axis the last one by a cyclic permutation, which preserves orientation.
  [[nodiscard]] Vec3 permuted(const Vec3& p) const {
    return axis_ == 2 ? p : axis_ == 1 ? Vec3(p.z, p.x, p.y) : Vec3(p.y, p.z, p.x);
  }
  [[nodiscard]] std::size_t cell(double x, int axis) const;

  Vec3 low_{0.0}, high_{0.0};
  double volume_m3_ = 0.0;
  int axis_ = 2;
  std::vector<Corners> triangles_;  // rotated by permuted()
  // A grid over the projection: for each cell the triangles that may wind around its points,
  // ordered by their farthest extent.
  std::size_t cells_ = 1;              // per axis
  Vec3 corner_{0.0}, cell_size_{1.0};  // rotated by permuted()
  std::vector<std::uint32_t> first_, of_cell_;
};

// Whether other faces cover the patch or part of it.
[[nodiscard]] bool is_covered_by_faces(const scenes::CoincidentFaces& coincident,
                                       const Patches& patches, std::uint32_t patch);

class ClosedBodies {
 public:
  // Points, here and below, are relative to `centre`. A body that contains a lamp is excluded.
  // earlier: of another pose, whose surfaces are used again where they are equal; may be null.
  ClosedBodies(const scenes::Scene& scene, const Vec3& centre,
               const ClosedBodies* earlier = nullptr);

  // Possible covers of points within margin_m of a patch: bodies, the dark outside, faces on the
  // patch's own triangles, and the holes of their opacity mask.
  [[nodiscard]] std::vector<std::uint32_t> near(const Patches& patches, std::uint32_t patch,
                                                double margin_m) const;
  [[nodiscard]] bool cover(const Vec3& point, std::span<const std::uint32_t> bodies) const;
  [[nodiscard]] const Vec3& centre() const { return centre_; }
  // Everything outside of rooms is covered.
  [[nodiscard]] bool has_dark_outside() const { return dark_outside_; }
  // Boxes, in the scene, of surfaces that cover points in one of two poses only.
  friend std::vector<scenes::Box> differing_bodies(const ClosedBodies& a, const ClosedBodies& b);

 private:
  using SharedSurface = std::shared_ptr<const ClosedSurface>;
  struct Body {
    SharedSurface surface;
    std::vector<std::uint32_t> cavities;
  };
  void find_holes(const scenes::Scene& scene);
  [[nodiscard]] bool in_hole(const Vec3& point, std::uint32_t number) const;
  void leave_out_lit(const scenes::Scene& scene);
  [[nodiscard]] bool in_room(const Vec3& point) const;
  [[nodiscard]] bool light_is_in_rooms(const scenes::Scene& scene,
                                       const std::vector<std::uint32_t>& part_of,
                                       const std::vector<char>& walls) const;

  Vec3 centre_;
  std::vector<Body> bodies_;
  std::vector<SharedSurface> cavities_;                 // including rooms
  std::map<std::uint32_t, SharedSurface> of_triangle_;  // all surfaces by their first triangle
  bool dark_outside_ = false;
  scenes::OpacityMasks masks_;
  struct Corners {
    Vec3 a, b, c;
  };
  std::vector<Corners> masked_;  // per masked triangle
  scenes::CoincidentFaces coincident_;
};

[[nodiscard]] std::vector<scenes::Box> differing_bodies(const ClosedBodies& a,
                                                        const ClosedBodies& b);

}  // namespace earthshine::radiosity
