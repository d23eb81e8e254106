// SPDX-License-Identifier: Apache-2.0
// Cells that walls stand on or pierce, parted along them: what is on one side of a wall has a patch
// of its own, so that the light of one room stays out of the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::radiosity {

// Where a wall meets the plane of a facet.
struct Trace {
  PlanePoint from, to;
  // Points with way . p >= reach are before the wall, where it has a back.
  PlanePoint way;
  double reach;
  Vec3 front;  // unit, in the facet's plane: where the wall's front looks
  // Of a closed body: what is behind is covered, unless the body ends there, and needs no patch.
  bool of_body;
};

// By facet.
class Traces {
 public:
  explicit Traces(std::vector<std::vector<Trace>> by_facet);

  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool any(std::uint32_t facet) const { return !of_[facet].empty(); }
  // Replaces `found` by those that may meet the cell, in their order.
  void near(std::uint32_t facet, const Outline& cell, std::vector<Trace>& found) const;

 private:
  std::vector<std::vector<Trace>> of_;
  bool any_ = false;
};

// The nodes refer to each other by their number here. No outlines: the cell stays whole.
struct PartedCell {
  std::vector<PartNode> nodes;
  std::vector<Outline> outlines;
};

// Of a whole cell. A wall parts it, by its line, if it takes up a quarter of that line's way
// through and leaves a ten thousandth of the cell on either side; a body's side only if another
// that looks the opposite way is behind it: a thin wall, both of whose sides have light.
[[nodiscard]] PartedCell part_cell(const Facet& facet, const Cell& cell,
                                   std::span<const Trace> traces);

// To part_nodes and outlines.
void append(Patches& patches, const PartedCell& parted);

// What Patches::find gives for a hit of a ray along `way`, moved back by back_m along it: at the
// foot of a wall rounding may have put the hit behind the wall.
[[nodiscard]] std::uint32_t find_before(const Patches& patches, const TrianglePlace& hit,
                                        bool front, const Vec3& way, double back_m);

// The cell of the facet as a polygon in its plane.
[[nodiscard]] Outline outline_of(const Facet& facet, const Cell& cell);

}  // namespace earthshine::radiosity
