// SPDX-License-Identifier: Apache-2.0
// How large the matrix of form factors will be, from a few of its rows, before it is cast.
#pragma once

#include <cstddef>

#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// Entries of a mean row when the scene is cut into `patches` and each sends rays_per_patch rays.
// Casts some rows of two even cuts, of about that number (2^17 at most) and of an eighth of it, and
// goes on from them by a power law: beyond 2^17 that lies above the truth, since a row fills up.
// Within a tenth where a few hundred rows say enough (1024 rays and less), a third elsewhere.
//
// Whether any row meets black backs: then some patches are buried in bodies, and no ray reaches
// them.
struct ExpectedRows {
  double entries = 0.0;
  bool meets_backs = false;
};
[[nodiscard]] ExpectedRows expected_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                                         std::size_t patches, int rays_per_patch);

// How many patches will be too small for any ray when the scene is cut evenly into `patches`: those
// borrow entries (balance), and the matrix is then copied. By reciprocity a patch of area a gets
// R a N / A rays of N patches with R rays each and A area in all, Poisson.
[[nodiscard]] double expected_unreached(const scenes::Scene& scene, std::size_t patches,
                                        int rays_per_patch);

}  // namespace earthshine::radiosity
