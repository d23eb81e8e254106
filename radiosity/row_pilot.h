// SPDX-License-Identifier: Apache-2.0
// How large the matrix of form factors will be, from a few of its rows, before it is cast.
#pragma once

#include <cstddef>

#include "radiosity/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// Entries of a mean row when the scene is cut into `patches` and each sends rays_per_patch rays.
// Casts 64 rows of an even cut of about that number; beyond 2^17 patches those of two smaller cuts,
// continued as a power law, which lies above the truth since a row fills up: the entries can be no
// more than the rays that land. Within a tenth or so for even cuts, as long as no patch stands out.
[[nodiscard]] double expected_row_entries(const scenes::Scene& scene, const scenes::RayQuery& query,
                                          std::size_t patches, int rays_per_patch);

// How many patches no ray will reach when the scene is cut evenly into `patches`: those borrow
// entries (balance), and the matrix is then copied. By reciprocity a patch of area a gets R a N / A
// rays of N patches with R rays each and A area in all, Poisson.
[[nodiscard]] double expected_unreached(const scenes::Scene& scene, std::size_t patches,
                                        int rays_per_patch);

}  // namespace earthshine::radiosity
