// SPDX-License-Identifier: Apache-2.0
// Standard errors of single form factors and of whole rows.
//
// A count of n hits among N independent rays has variance n (1 - n / N). Owen-Sobol rays spread
// more evenly, by a gain that grows with the number of hits that a patch takes: their set resolves
// the patch's outline in the four dimensions of the sampling (Owen 1997; a region met by h points
// has about h^(3/4) of them at its border). The gain is not assumed but measured on the scene at
// hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// Variance of a count over that of independent rays, by the expected number of hits.
struct RayErrorLaw {
  int rays_per_patch = 0;
  std::vector<double> hits;  // ascending: means of the measured classes
  std::vector<double> gain;  // at those; linear in log(hits) between, constant beyond

  // Of a share found by `hits` of the rays; a share that no ray found is given that of one hit.
  [[nodiscard]] double variance(double hits) const;
};

// Casts 8 independent replicates of the rows of up to `pilots` patches spread over the scene and
// compares each entry's spread with the binomial one, in classes of a factor 2 of its mean hits.
// options are those of the matrix that the law is for.
[[nodiscard]] RayErrorLaw measure_error_law(const scenes::Scene& scene,
                                            const scenes::RayQuery& query, const Patches& patches,
                                            const FormFactorOptions& options,
                                            std::size_t pilots = 48);

// Of F_ij, entry e of row i.
[[nodiscard]] double entry_std_error(const RayErrorLaw& law, const FormFactors& factors,
                                     std::size_t row, std::uint64_t entry);
// Of a row: the root of the expected sum over j of the squared errors of F_ij.
[[nodiscard]] double row_std_error(const RayErrorLaw& law, const FormFactors& factors,
                                   std::size_t row);

}  // namespace earthshine::radiosity
