// SPDX-License-Identifier: Apache-2.0
// From the light on patches to a Solution with its ledger.
#pragma once

#include <span>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Per own row of the factors and column, unless said otherwise.
struct PatchLight {
  std::vector<double> reflectance;                           // reflectances(): three a row
  std::vector<double> emitted, direct, indirect, radiosity;  // exitances(); lx, lx, lm/m^2
  std::span<const Rgb> sky;  // per patch and part of the sky: what of `direct` gather rays bring
};

[[nodiscard]] std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                               base::Shares::Range rows);
// Of what is carried by form factors.
[[nodiscard]] std::vector<double> exitances(const scenes::Scene& scene,
                                            const scenes::LightGroups& groups,
                                            const Patches& patches, base::Shares::Range rows);

// Of solution.patches and solution.columns. Of the factors only what each patch keeps, loses and
// lets escape is looked at, and what is open of it. Closes the energy of `light`. Of ranks that
// divide the factors each gives its own rows' light; all get all of the solution.
void fill_solution(const scenes::World& world, const FormFactors& factors, bool balanced,
                   PatchLight light, Solution& solution);

// solve() on patches that are cut already, with its form factors, balanced.
[[nodiscard]] Solution solve_keeping(const scenes::World& world, const SolveOptions& options,
                                     Patches patches, const SolveVariant& variant,
                                     FormFactors& factors);

// Where the energy went. With F balanced (form_factors.h) every line adds up to rounding and the
// solver's residual:
//   given   = emitted + landed + what sources lose at once (direct.h), where given is the photometric
//             flux
//   emitted = sum A M            patches that shine through F
//   landed  = sum A d E0         direct light, as computed
//   absorbed = sum A ((a - rho) F B + (d - rho) E0) + sum A B lost
//   escaped  = sum A B escape
// d is 1 less what goes on through glass that does not bend light and off flat mirrors, which lands
// elsewhere. What other mirrors and glass would throw counts as absorbed there, what comes to a
// second flat mirror as lost by the source.

struct LedgerInput {
  const FormFactors& factors;
  std::span<const double> area_m2;  // what is open of each patch
  std::size_t columns = 0;
  std::span<const double> reflectance;  // own rows x 3
  std::span<const double> emitted;      // all below: own rows x columns; M through F
  std::span<const double> direct;       // E0
  std::span<const double> indirect;     // F B
  std::span<const double> radiosity;    // B
};

// Whether the Sun or the Earth shines in each group.
[[nodiscard]] std::vector<bool> sky_groups(const scenes::World& world);

[[nodiscard]] std::vector<GroupLedger> energy_ledger(const LedgerInput& input,
                                                     const scenes::World& world,
                                                     std::span<const SourceFlux> sources);

// Scales each column of B and of F B so that its energy adds up to rounding. Summed with the areas
// as weights, (1 - rho F) B = S says emitted + landed = absorbed + escaped; what the solver left of
// that sum, a share of about its residual, is made good by B as a whole, and where the form factors
// are balanced so is what their rounding left, which a million reflections make a million times
// larger than rounding. What unbalanced form factors leave is not touched. `radiosity` and
// `indirect` are the vectors that `input` views.
void close_energy(const LedgerInput& input, bool balanced, std::span<double> radiosity,
                  std::span<double> indirect);

}  // namespace earthshine::radiosity
