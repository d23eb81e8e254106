// SPDX-License-Identifier: Apache-2.0
// Adds hits that make a pattern scalable in rows and columns (balance, form_factors.h). With few
// rays some patterns have no scaling: i hit j, but no path of hits leads back from j to i; or all
// rays of two small patches hit one smaller patch.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// A patch that no ray hit has an empty column, which cannot be scaled; one that only a tiny patch's
// rays hit would need a scale of a million. Reciprocity gives its entries: n_ij = n_ji A_j / A_i
// for the patches i that its own rays hit. Returns the number of such patches.
std::size_t borrow_starved_columns(FormFactors& factors, std::span<const double> area_m2);

// Makes any pattern of hits scalable. Where i hit j but j did not hit i, j gets `reciprocal_share`
// of the reciprocal entry A_i F_ij / A_j. A closed patch (no hits of the sky or a black back) gets
// a self-form-factor of `own_share`.
//
// This is sufficient (Sinkhorn and Knopp 1967): a scaling exists if some matrix with the required
// sums is positive exactly on the pattern. With d > 0 on the diagonal and the symmetric pattern S,
// diag(A - t S 1) + t S is such a matrix for small t; sky and backs supply the rest. Scaling gives
// the matrix nearest to the hits in relative entropy, so that small unnecessary entries stay small:
// rows remain as the rays found them.
//
// `factors`: as cast, without scales. Returns the number of new entries.
// `factors` as cast, with no scales yet. Returns how many entries are new.
inline constexpr double reciprocal_share = 0.01, own_share = 0.001;
std::size_t fill_reciprocal(FormFactors& factors, std::span<const double> area_m2);

// Whether fill_reciprocal gives the patch a self-form-factor.
[[nodiscard]] bool keeps_its_own(const FormFactors& factors, std::span<const double> area_m2,
                                 std::size_t patch);

}  // namespace earthshine::radiosity
