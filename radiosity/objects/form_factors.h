// SPDX-License-Identifier: Apache-2.0
// Form factors between whole objects of the scene (all their sides), with standard errors. As in a
// solve, points inside a body (closed_bodies.h) are excluded: means are over the open parts.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"
#include "scenes/ray_query.h"

namespace earthshine::radiosity {

// F[i][j]: share of the light that arrives at object j from object i with uniform radiosity.
struct ObjectFormFactors {
  std::vector<std::vector<double>> F, std_error;
  std::vector<double> sky, sky_std_error;      // F to the sky
  std::vector<double> black, black_std_error;  // F to black backs
  std::vector<double> area_m2;                 // both sides of sheets, including covered parts
  std::vector<double> open_area_m2;            // A_i: the open area
  // max_i |sum_j F_ij + sky_i + black_i - 1|, without the shares of mirrors and glass
  double max_row_error = 0.0;
  // max over pairs of |A_i F_ij - A_j F_ji| / max(A_i F_ij, A_j F_ji), where both exceed 4 standard
  // errors
  double max_reciprocity_error = 0.0;
};

// Area means of a matrix between patches. The standard errors remain 0.
[[nodiscard]] ObjectFormFactors object_form_factors(const scenes::Scene& scene,
                                                    const Patches& patches,
                                                    const FormFactors& factors);

struct ObjectFactorOptions {
  int rays_per_patch = 1024;  // total of all replicates
  std::uint64_t seed = 1;
  bool raw = false;  // as cast: every row is closed, reciprocity holds within the noise
};

struct ObjectFactorReport {
  int replicates = 0;
  int rays_per_patch = 0;
  std::uint64_t rays = 0;
  double row_error_before = 0.0, reciprocity_error_before = 0.0;
  bool reconciled = false;
  // Pairs whose two estimates differ by more than 6 standard errors; their error is half of that.
  std::size_t disagreeing_pairs = 0;
};

inline constexpr std::uint32_t ray_replicates = 16;

// By rays. Sixteen independent Owen-Sobol replicates of every patch's rays measure the noise: hits
// of a single set are correlated, and the binomial formula is wrong by factors of 3 to 50. Unless
// `raw`, the two estimates of each pair, A_i F_ij and A_j F_ji, are combined with the weights of
// their rays per area, and weighted least squares closes the rows. Both laws then hold; the factor
// of a tiny object that a wall's rays missed comes from its own rays. Scenes with mirrors or glass
// stay raw. Standard errors: 64 balanced random sign patterns of the replicates, each with the same
// linear steps (half-sample replication, McCarthy 1969). An entry without hits has the error of one
// hit.
[[nodiscard]] ObjectFormFactors object_form_factors_by_rays(const scenes::Scene& scene,
                                                            const scenes::RayQuery& query,
                                                            const Patches& patches,
                                                            const ObjectFactorOptions& options,
                                                            ObjectFactorReport& report);

}  // namespace earthshine::radiosity
