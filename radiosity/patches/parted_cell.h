// SPDX-License-Identifier: Apache-2.0
// Divides cells along walls that stand on or pierce them: each side of a wall has its own patch, so
// that the light of one room does not leak into the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// Intersection of a wall with the plane of a facet.
struct Trace {
  PlanePoint from, to;
  // Points with normal . p >= reach are in front of the wall, if it is one-sided.
  PlanePoint normal;
  double reach;
  Vec3 front;  // unit, in the facet's plane: direction of the wall's front
  // Of a closed body: its inside is covered, unless the body ends there, and needs no patch.
  bool of_body;
};

// Traces by facet.
class Traces {
 public:
  explicit Traces(std::vector<std::vector<Trace>> by_facet);

  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool any(std::uint32_t facet) const { return !of_[facet].empty(); }
  // Replaces `found` by the traces that may meet the cell, in order.
  void near(std::uint32_t facet, const Outline& cell, std::vector<Trace>& found) const;

 private:
  std::vector<std::vector<Trace>> of_;
  bool any_ = false;
};

// Nodes refer to each other by index. Without outlines the cell stays whole.
struct PartedCell {
  std::vector<PartNode> nodes;
  std::vector<Outline> outlines;
};

// Divides a whole cell. A wall divides it, along its line, if it covers a quarter of the line's
// length in the cell and leaves at least a ten-thousandth of the cell on either side. A body's side
// divides it only if another side with the opposite orientation is behind it: a thin wall, lit on
// both sides.
[[nodiscard]] PartedCell part_cell(const Facet& facet, const Cell& cell,
                                   std::span<const Trace> traces);

// Appends to part_nodes and outlines.
void append(Patches& patches, const PartedCell& parted);

// Patch of a ray's hit, as Patches::find, after moving the hit back by back_m along `direction`: at
// the foot of a wall rounding may have put the hit behind the wall.
[[nodiscard]] std::uint32_t find_before(const Patches& patches, const TrianglePlace& hit,
                                        bool front, const Vec3& direction, double back_m);

// The cell of the facet as a polygon in its plane.
[[nodiscard]] Outline outline_of(const Facet& facet, const Cell& cell);

}  // namespace earthshine::radiosity
