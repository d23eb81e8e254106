// SPDX-License-Identifier: Apache-2.0
// Bodies that hide what stands or lies in them: the part of a floor under a box, the part of a
// strut inside a wall. No light reaches such points and none leaves them.
//
// A body is a closed surface of opaque one-sided faces that look outward: parts that hang together
// by edges (alike corners to the last bit), every edge used equally often both ways. How often such
// a surface winds around a point is a whole number, whatever way one looks: 1 inside, 0 outside. A
// room that is seen from inside (faces inward, winding -1) covers nothing, and lays open what it
// takes from a body around it (a house: walls within an outer shell). Where all light there is
// shines in such rooms, what pokes out of them is covered too: the foot of a box that stands on a
// floor, or is sunk in it, has nothing to receive beyond the floor and nobody to send it to.
// A hole that rests on another surface all around is stopped up by it (closed_parts.h).
// Sheets, glass, other open meshes and meshes with some faces turned over cover nothing: where
// their inside is cannot be told. Faces that lie on others (scenes/health/coincident.h) are counted
// with what covers, and the holes of an opacity mask with what is covered: nothing is there either.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patches/patches.h"
#include "scenes/coincident_faces.h"
#include "scenes/scene.h"
#include "scenes/surface_texture.h"

namespace earthshine::radiosity {

// A closed surface, seen along its shortest side: the number of times that it winds around a point
// is the sum over its triangles beyond the point of the times that they wind around it in
// projection, +1, 0 or -1. Each edge is decided once for both of its triangles, so that no point
// falls between two of them.
class ClosedSurface {
 public:
  // Three corners a triangle.
  explicit ClosedSurface(std::span<const Vec3> corners);

  [[nodiscard]] int winding(const Vec3& point) const;
  [[nodiscard]] bool may_wind(const Vec3& low, const Vec3& high) const {
    return glm::all(glm::lessThanEqual(low, high_)) && glm::all(glm::lessThanEqual(low_, high));
  }
  [[nodiscard]] bool lies_in_box_of(const ClosedSurface& other) const {
    return glm::all(glm::greaterThanEqual(low_, other.low_)) &&
           glm::all(glm::lessThanEqual(high_, other.high_));
  }
  [[nodiscard]] double volume_m3() const { return volume_m3_; }  // positive if it looks outward
  [[nodiscard]] double box_m3() const {
    const Vec3 size = high_ - low_;
    return size.x * size.y * size.z;
  }

 private:
  struct Corners {
    Vec3 a, b, c;
  };
  // The axis to look along comes last; a turn, so that what ran counter-clockwise still does.
  [[nodiscard]] Vec3 turned(const Vec3& p) const {
    return axis_ == 2 ? p : axis_ == 1 ? Vec3(p.z, p.x, p.y) : Vec3(p.y, p.z, p.x);
  }
  [[nodiscard]] std::size_t cell(double x, int way) const;

  Vec3 low_{0.0}, high_{0.0};
  double volume_m3_ = 0.0;
  int axis_ = 2;
  std::vector<Corners> triangles_;  // turned
  // A grid over the projection: which triangles may wind around a cell's points, those that reach
  // farthest first.
  std::size_t cells_ = 1;              // per way
  Vec3 corner_{0.0}, cell_size_{1.0};  // turned
  std::vector<std::uint32_t> first_, of_cell_;
};

// Whether other faces lie on the patch, or part of it.
[[nodiscard]] bool is_covered_by_faces(const scenes::CoincidentFaces& coincident,
                                       const Patches& patches, std::uint32_t patch);

class ClosedBodies {
 public:
  // Points, here and below, are relative to `centre`. A body in which a lamp stands is none.
  ClosedBodies(const scenes::Scene& scene, const Vec3& centre);

  // What may cover points within margin_m of a patch: bodies, the dark outside, what lies on the
  // patch's own triangles, and the holes of their opacity mask, where they are not.
  [[nodiscard]] std::vector<std::uint32_t> near(const Patches& patches, std::uint32_t patch,
                                                double margin_m) const;
  [[nodiscard]] bool cover(const Vec3& point, std::span<const std::uint32_t> bodies) const;
  [[nodiscard]] const Vec3& centre() const { return centre_; }

 private:
  struct Body {
    ClosedSurface surface;
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
  std::vector<ClosedSurface> cavities_;  // rooms among them
  bool dark_outside_ = false;
  scenes::OpacityMasks masks_;
  struct Corners {
    Vec3 a, b, c;
  };
  std::vector<Corners> masked_;  // per masked triangle
  scenes::CoincidentFaces coincident_;
};

}  // namespace earthshine::radiosity
