// SPDX-License-Identifier: Apache-2.0
// The solution as rays read it: radiance B / pi at any surface point, per image layer, flat in
// memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patches/patches.h"
#include "radiosity/solution.h"
#include "raytrace/incoming/leak_mask.h"

namespace earthshine::raytrace {

// layers: 1 (all light groups summed) or one per group. Between the centres of a facet's cells the
// radiance is interpolated bilinearly, which makes the error of reading it fall with the square of
// the patch edge; where cells of different sizes meet, between their knots (below).
// Cells of a cluster (radiosity/patches/clusters.h) show one radiance each.
// Across what stands between two cells (leak_mask.h) nothing is interpolated: a cell takes its own
// radiance where it would take that of one that it does not see.
class RadianceTable {
 public:
  RadianceTable() = default;
  // values: radiosity or indirect_radiosity of the solution. `sight`, like the solution, must
  // outlive the table.
  RadianceTable(const radiosity::Solution& solution, std::span<const float> values, bool per_light,
                const LeakMask& sight);

  [[nodiscard]] bool empty() const { return radiance_.empty(); }

  // Adds weight * radiance to out[0 .. layers). Nothing for the black back of a one-sided surface.
  void add(const scenes::Hit& hit, const Rgb& weight, std::span<Rgb> out) const;

 private:
  void fill_knots();
  void add_uneven(const radiosity::Facet& facet, bool front, const radiosity::Parameters& where,
                  const Rgb& weight, std::span<Rgb> out) const;

  const radiosity::Patches* patches_ = nullptr;
  const LeakMask* sight_ = nullptr;
  std::size_t layers_ = 0;
  std::vector<glm::vec4> radiance_;  // patch * layers + layer; fourth component unused
  // Facets with a tree: (leaf * knots_per_cell + knot) * layers + layer from where the side starts.
  std::vector<glm::vec4> knots_;
  std::vector<std::array<std::size_t, 2>> side_knots_;  // per facet: back, front
};

// Interpolation on facets whose cells are cut unevenly. Every cell has nine knots: its centre, its
// corners and the middles of its sides. Between four of them the radiance is bilinear; where all
// cells are alike that is the same as interpolating between the centres. A knot on a larger
// neighbour's side that is none of the neighbour's own knots takes its value from the two that are,
// so that both cells agree along the side they share.

inline constexpr std::size_t knots_per_cell = 9;

struct KnotTerm {
  std::uint32_t leaf;  // of the facet
  float weight;
};

// What the value at knot 3 i + j of a leaf is made of, appended to `terms`: i = 0, 1, 2 along s, j
// along t. The weights add up to 1, and a function linear in (s, t) is met exactly except in the
// outer half of the cells at the facet's edge, where it is taken as constant outward.
void add_knot_terms(const radiosity::Patches& patches, const radiosity::Facet& facet,
                    std::uint32_t leaf, std::uint32_t i, std::uint32_t j,
                    std::vector<KnotTerm>& terms);

}  // namespace earthshine::raytrace
