// SPDX-License-Identifier: Apache-2.0
// Form factors without rays, for up to some thousand patches and whole facets: analytic where a
// pair sees each other wholly (polygon_factor.h), shadows cut exactly and integrated to a tolerance
// where it does not (hidden_factor.h).
//
//   F_ij = row_scale_i hits_ij,  hits_ij the computed F_ij as float,  column_scale = kept = 1
//   sum_j F_ij + F_i,sky + F_i,black = 1 to the last digits
//
// F_ij is the mean over what no body covers of patch i (factors.open), as in the factors by rays.
// What a row leaves open, 1 - sum_j F_ij, is split between the sky and black backs by rays of the
// patch; a row none of whose rays ends on either and whose sum is 1 within its errors is closed and
// scaled to 1. Every defect that was scaled away is in the report.
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
  std::uint64_t pairs = 0;  // unordered, and their kinds below
  PairCounts counts;
  double estimated_error = 0.0;  // greatest over rows of sqrt(sum_j dF_ij^2), estimated
  // Per patch, of F_i,sky and F_i,black alike: what the rays leave open about the split between
  // them.
  std::vector<double> split_std_error;
  std::vector<double> open_std_error;  // per patch, of factors.open.share, which points find
  std::size_t closed_rows = 0;
  double max_closed_defect = 0.0;  // greatest |1 - sum_j F_ij| of closed rows before scaling
  // Per patch: how far 1 - sum_j F_ij is from the share of the patch's rays that ends on the sky or
  // on black backs, where that is more than six standard errors of both; else 0.
  std::vector<double> disagreement;
  std::size_t disagreeing_rows = 0;
  std::size_t overfull_rows = 0;  // open rows with sum_j F_ij > 1, scaled to 1
  double max_overfull = 0.0;      // the greatest sum_j F_ij - 1 among them
};

struct ExactFormFactors {
  FormFactors factors;
  ExactReport report;
};

// Memory: 4 n^2 bytes for the pairs and 8 for each nonzero. The same bytes for any number of
// threads. Throws base::Error (Input) for scenes with mirrors or glass, which this cannot follow,
// and for more than most_exact_patches patches.
inline constexpr std::size_t most_exact_patches = 30000;
[[nodiscard]] ExactFormFactors exact_form_factors(const scenes::Scene& scene,
                                                  const scenes::RayQuery& query,
                                                  const Patches& patches,
                                                  const ExactOptions& options,
                                                  const SkyRadiance& sky = {});

}  // namespace earthshine::radiosity
