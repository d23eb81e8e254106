// SPDX-License-Identifier: Apache-2.0
// Interpolation on facets whose cells are cut unevenly. Every cell has nine knots: its centre, its
// corners and the middles of its sides. Between four of them the radiance is bilinear; where all
// cells are alike that is the same as interpolating between the centres. A knot on a larger
// neighbour's side that is none of the neighbour's own knots takes its value from the two that are,
// so that both cells agree along the side they share.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patches/patches.h"

namespace earthshine::raytrace {

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
