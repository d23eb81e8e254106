// SPDX-License-Identifier: Apache-2.0
// Predicts the size of the form-factor matrix from a few rows before it is cast.
#pragma once

#include <cstddef>

#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// Mean number of entries per row for `patches` patches with rays_per_patch rays each. Casts some
// rows of two uniform divisions, with about this number (2^17 at most) and an eighth of it, and
// extrapolates by a power law: above 2^17 this overestimates, since rows saturate. Error a tenth if
// a few hundred rows suffice (up to 1024 rays), otherwise a third.
//
// Also whether any row hits black backs: then some patches are inside bodies and no ray reaches
// them.
struct ExpectedRows {
  double entries = 0.0;
  bool meets_backs = false;
};
[[nodiscard]] ExpectedRows expected_rows(const scenes::Scene& scene, const scenes::RayQuery& query,
                                         std::size_t patches, int rays_per_patch);

// Expected number of patches that no ray hits in a uniform division into `patches`. They borrow
// entries (balance), for which the matrix is copied. By reciprocity a patch of area a gets R a N /
// A rays from N patches with R rays each and total area A, Poisson-distributed.
[[nodiscard]] double expected_unreached(const scenes::Scene& scene, std::size_t patches,
                                        int rays_per_patch);

}  // namespace earthshine::radiosity
