// SPDX-License-Identifier: Apache-2.0
// The radiance B / pi of the solution at any surface point, per image layer, for look-ups by rays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patches/patches.h"
#include "radiosity/solution.h"
#include "raytrace/incoming/leak_mask.h"

namespace earthshine::raytrace {

// layers: 1 (sum of all light groups) or one per group. Radiance is interpolated bilinearly between
// the centres of a facet's cells, so that its error falls with the square of the patch edge; cells
// of different sizes are interpolated between knots (below). Cells of a cluster
// (radiosity/patches/clusters.h) have constant radiance. Across an occluder between two cells
// (leak_mask.h) each cell uses its own radiance in place of the other's.
class RadianceTable {
 public:
  RadianceTable() = default;
  // values: radiosity or indirect_radiosity of the solution. The solution and `sight` must outlive
  // the table.
  RadianceTable(const radiosity::Solution& solution, std::span<const float> values, bool per_light,
                const LeakMask& sight);

  [[nodiscard]] bool empty() const { return radiance_.empty(); }

  // Adds weight * radiance to out[0 .. layers). The black back of a one-sided surface adds nothing.
  void add(const scenes::Hit& hit, const Rgb& weight, std::span<Rgb> out) const;

 private:
  void fill_knots();
  void add_uneven(const radiosity::Facet& facet, bool front, const radiosity::Parameters& where,
                  const Rgb& weight, std::span<Rgb> out) const;

  const radiosity::Patches* patches_ = nullptr;
  const LeakMask* sight_ = nullptr;
  std::size_t layers_ = 0;
  std::vector<glm::vec4> radiance_;  // patch * layers + layer; fourth component unused
  // Facets with a tree: (leaf * knots_per_cell + knot) * layers + layer, from side_knots_ on.
  std::vector<glm::vec4> knots_;
  std::vector<std::array<std::size_t, 2>> side_knots_;  // per facet: start of back, front
};

// Interpolation on facets with cells of different sizes. Every cell has nine knots: its centre,
// corners and the midpoints of its sides. Radiance is bilinear between four of them; with equal
// cells this equals interpolation between the centres. A knot on the side of a larger neighbour
// that is not one of its knots is interpolated between two that are, so that the radiance is
// continuous across the side.

inline constexpr std::size_t knots_per_cell = 9;

struct KnotTerm {
  std::uint32_t leaf;  // of the facet
  float weight;
};

// Appends the weights of the cells' values at knot 3 i + j of a leaf: i = 0, 1, 2 along s, j along
// t. The weights add up to 1. Functions linear in (s, t) are reproduced, except in the outer half
// of the cells at the facet's edge, where the values are extrapolated as constants.
void add_knot_terms(const radiosity::Patches& patches, const radiosity::Facet& facet,
                    std::uint32_t leaf, std::uint32_t i, std::uint32_t j,
                    std::vector<KnotTerm>& terms);

}  // namespace earthshine::raytrace
