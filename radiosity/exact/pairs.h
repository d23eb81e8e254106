// SPDX-License-Identifier: Apache-2.0
// A_i F_ij for every pair of patches, without rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/exact/facet_sides.h"
#include "radiosity/exact/open_parts.h"

namespace earthshine::radiosity {

struct PairCounts {
  std::uint64_t facing_away = 0;  // coplanar or behind each other: 0 at no cost
  std::uint64_t unoccluded = 0;
  std::uint64_t partly_hidden = 0;
  std::uint64_t wholly_hidden = 0;
  std::uint64_t points = 0;  // at which shadows were cut
};

// Symmetric by construction: each unordered pair is computed once.
struct PairExchange {
  std::size_t count = 0;
  std::vector<double> upper_m2;          // A_i F_ij for i < j, by rows
  std::vector<double> row_square_error;  // sum over j of the squared estimated errors of F_ij
  PairCounts counts;

  [[nodiscard]] std::size_t index(std::size_t i, std::size_t j) const {  // i < j
    return i * (2 * count - i - 1) / 2 + (j - i - 1);
  }
};

// Uses the open parts in `covers`, one entry per patch; empty: nothing is covered. tolerance: of
// each partly hidden F_ij, absolute. The result does not depend on the number of threads.
[[nodiscard]] PairExchange exchange_of_pairs(const Patches& patches, const FacetSides& sides,
                                             std::span<const PatchCover> covers, double tolerance);

}  // namespace earthshine::radiosity
