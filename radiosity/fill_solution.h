// SPDX-License-Identifier: Apache-2.0
// From the light on patches to a Solution with its ledger.
#pragma once

#include <span>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Per patch and column, unless said otherwise.
struct PatchLight {
  std::vector<double> reflectance, emitted;         // reflectances(), exitances()
  std::vector<double> direct, indirect, radiosity;  // lx, lx, lm/m^2
  std::span<const Rgb> sky;  // per patch and part of the sky: what of `direct` gather rays bring
};

[[nodiscard]] std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                               std::size_t groups);
// Of what is carried by form factors.
[[nodiscard]] std::vector<double> exitances(const scenes::Scene& scene,
                                            const scenes::LightGroups& groups,
                                            const Patches& patches);

// Of solution.patches and solution.columns. Of the factors only what each patch keeps, loses and
// lets escape is looked at, and what is open of it. Closes the energy of `light` (ledger.h).
void fill_solution(const scenes::Scene& scene, const scenes::LightGroups& groups,
                   const scenes::Effects& effects, const FormFactors& factors, bool balanced,
                   PatchLight& light, Solution& solution);

// solve() on patches that are cut already, with its form factors, balanced.
[[nodiscard]] Solution solve_keeping(const scenes::Scene& scene, const scenes::LightGroups& groups,
                                     const scenes::Effects& effects, const scenes::RayQuery& query,
                                     const SolveOptions& options, Patches patches,
                                     const SolveVariant& variant, FormFactors& factors);

}  // namespace earthshine::radiosity
