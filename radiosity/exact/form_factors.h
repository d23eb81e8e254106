// SPDX-License-Identifier: Apache-2.0
// Form factors without rays, for up to some thousand patches and for whole facets: analytic for
// unoccluded pairs (polygon_factor.h), exact shadows integrated to a tolerance for partly occluded
// pairs (hidden_factor.h).
//
//   F_ij = row_scale_i hits_ij,  hits_ij the computed F_ij as float,  column_scale = kept = 1
//   sum_j F_ij + F_i,sky + F_i,black = 1 to rounding
//
// F_ij is the mean over the open part of patch i (factors.open), as for factors by rays. Rays of
// the patch divide the open share, 1 - sum_j F_ij, between the sky and black backs. A row without
// such rays whose sum is 1 within its errors is closed and scaled to 1. The report has every defect
// that was removed by scaling.
#pragma once

#include <vector>

#include "radiosity/exact/pairs.h"
#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

struct ExactOptions {
  double tolerance = 1e-5;  // of each partly hidden F_ij, absolute
  int split_rays = 256;     // per patch; rounded up to a power of two
  std::uint64_t seed = 1;   // of those rays
};

struct ExactReport {
  std::uint64_t pairs = 0;  // unordered; their kinds below
  PairCounts counts;
  double estimated_error = 0.0;  // largest over rows of sqrt(sum_j dF_ij^2), estimated
  // Per patch, for F_i,sky and F_i,black: standard error of the division between them by rays.
  std::vector<double> split_std_error;
  std::vector<double> open_std_error;  // per patch, of factors.open.share, estimated by points
  std::size_t closed_rows = 0;
  double max_closed_defect = 0.0;  // largest |1 - sum_j F_ij| of closed rows before scaling
  // Per patch: difference of 1 - sum_j F_ij from the share of rays that end on the sky or on black
  // backs, if it exceeds six standard errors; else 0.
  std::vector<double> disagreement;
  std::size_t disagreeing_rows = 0;
  std::size_t overfull_rows = 0;  // open rows with sum_j F_ij > 1, scaled to 1
  double max_overfull = 0.0;      // largest sum_j F_ij - 1 of these rows
};

struct ExactFormFactors {
  FormFactors factors;
  ExactReport report;
};

// Memory: 4 n^2 bytes for the pairs and 8 per nonzero. The result does not depend on the number of
// threads. Throws base::Error (Input) for scenes with mirrors or glass, which are not supported,
// and for more than most_exact_patches patches.
inline constexpr std::size_t most_exact_patches = 30000;
[[nodiscard]] ExactFormFactors exact_form_factors(const scenes::Scene& scene,
                                                  const scenes::RayQuery& query,
                                                  const Patches& patches,
                                                  const ExactOptions& options,
                                                  const SkyRadiance& sky = {});

}  // namespace earthshine::radiosity
