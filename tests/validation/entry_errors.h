// SPDX-License-Identifier: Apache-2.0
// Standard errors of single form factors and of whole rows.
//
// For independent rays a count of n hits among N has the variance n (1 - n / N). Owen-Sobol rays
// have a smaller variance, by a gain that grows with the number of hits of a patch: the points
// resolve the patch's outline in the four dimensions of the sampling (Owen 1997; of h points in a
// region about h^(3/4) are at its border). The gain is measured for each scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"

namespace earthshine::radiosity {

// Variance of a count relative to independent rays, as a function of the expected hits.
struct RayErrorLaw {
  int rays_per_patch = 0;
  std::vector<double> hits;  // ascending: means of the measured classes
  std::vector<double> gain;  // at `hits`; linear in log(hits) between them, constant beyond

  // Variance of a share found by `hits` rays; without hits, that for one hit.
  [[nodiscard]] double variance(double hits) const;
};

// Casts 8 independent replicates of the rows of up to `pilots` patches from all over the scene.
// Compares the variance of each entry with the binomial one, in classes of a factor 2 in mean hits.
// options: those of the matrix for which the law is used.
[[nodiscard]] RayErrorLaw measure_error_law(const scenes::Scene& scene,
                                            const scenes::RayQuery& query, const Patches& patches,
                                            const FormFactorOptions& options,
                                            std::size_t pilots = 48);

// Standard error of F_ij, entry e of row i.
[[nodiscard]] double entry_std_error(const RayErrorLaw& law, const FormFactors& factors,
                                     std::size_t row, std::uint64_t entry);
// Standard error of a row: root of the expected sum over j of the squared errors of F_ij.
[[nodiscard]] double row_std_error(const RayErrorLaw& law, const FormFactors& factors,
                                   std::size_t row);

}  // namespace earthshine::radiosity
