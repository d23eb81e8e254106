// SPDX-License-Identifier: Apache-2.0
// Hits that no ray made, without which rows and columns cannot both be scaled to their sums
// (balance, form_factors.h). Few rays leave patterns of hits that admit no scaling: i met j, but
// nothing that j met leads back to i; or all rays of two small patches met one that is smaller.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// A patch that no ray reached has an empty column, which no scaling can fill; one that only a
// speck's rays reached would need a scale of a million. Reciprocity gives its entries: n_ij = n_ji
// A_j / A_i for the patches i that it saw itself. Returns how many patches borrowed so.
std::size_t borrow_starved_columns(FormFactors& factors, std::span<const double> area_m2);

// Makes any pattern of hits one that can be scaled. Where i met j and j did not meet i, j gets
// `reciprocal_share` of the entry that reciprocity gives, A_i F_ij / A_j; and a closed patch (one
// that saw neither the sky nor a black back) keeps `own_share` of its light for itself.
//
// That suffices (Sinkhorn and Knopp 1967): a scaling exists if some matrix of the wanted sums is
// positive where the pattern is and nowhere else. With d > 0 on the diagonal and S the symmetric
// pattern, diag(A - t S 1) + t S is one, for any t small enough; sky and backs give and take what
// is asked of them. Scaling takes the matrix nearest to the hits in relative entropy, so that what
// is small and not needed stays small: rows stay as the rays found them.
//
// `factors` as cast, with no scales yet. Returns how many entries are new.
inline constexpr double reciprocal_share = 0.01, own_share = 0.001;
std::size_t fill_both_ways(FormFactors& factors, std::span<const double> area_m2);

// Whether fill_both_ways lets the patch keep light for itself.
[[nodiscard]] bool keeps_its_own(const FormFactors& factors, std::span<const double> area_m2,
                                 std::size_t patch);

}  // namespace earthshine::radiosity
