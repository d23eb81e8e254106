// SPDX-License-Identifier: Apache-2.0
// Combines the light on patches to a Solution with its energy ledger.
#pragma once

#include <span>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// One value per row of this rank's form factors and per column, unless stated otherwise.
struct PatchLight {
  std::vector<double> reflectance;                           // reflectances(): three a row
  std::vector<double> emitted, direct, indirect, radiosity;  // exitances(); lx, lx, lm/m^2
  std::span<const Rgb> sky;  // per patch and part of the sky: share of `direct` by gather rays
};

[[nodiscard]] std::vector<double> reflectances(const scenes::Scene& scene, const Patches& patches,
                                               base::Shares::Range rows);
// Exitance carried by form factors.
[[nodiscard]] std::vector<double> exitances(const scenes::Scene& scene,
                                            const scenes::LightGroups& groups,
                                            const Patches& patches, base::Shares::Range rows);

// Fills all members except solution.patches and solution.columns. Of the factors uses the kept,
// lost and escaped shares and the open shares. Calls close_energy for `light`. Each rank that
// divides the factors passes the light of its own rows; all receive the complete solution.
void fill_solution(const scenes::World& world, const FormFactors& factors, bool balanced,
                   PatchLight light, Solution& solution);

// solve() on given patches, including their balanced form factors.
[[nodiscard]] Solution solve_keeping(const scenes::World& world, const SolveOptions& options,
                                     Patches patches, const SolveVariant& variant,
                                     FormFactors& factors);

// Energy ledger. With balanced F (form_factors.h) every line holds to rounding and the solver's
// residual:
//   given    = emitted + landed + losses of sources (direct.h); given is the photometric flux
//
//   emitted  = sum A M           surfaces whose exitance F carries
//   landed   = sum A d E0        direct light, as computed
//   absorbed = sum A ((a - rho) F B + (d - rho) E0) + sum A B lost
//   escaped  = sum A B escape
// d is 1 minus the share that continues through glass without refraction and off flat mirrors,
// which lands elsewhere. Light that other mirrors and glass would transmit counts as absorbed
// there, light at a second flat mirror as lost by the source.

struct LedgerInput {
  const FormFactors& factors;
  std::span<const double> area_m2;  // open area of each patch
  std::size_t columns = 0;
  std::span<const double> reflectance;  // own rows x 3
  std::span<const double> emitted;      // these: own rows x columns; exitance M through F
  std::span<const double> direct;       // E0
  std::span<const double> indirect;     // F B
  std::span<const double> radiosity;    // B
};

// Per group: whether the Sun or the Earth emits in it.
[[nodiscard]] std::vector<bool> sky_groups(const scenes::World& world);

[[nodiscard]] std::vector<GroupLedger> energy_ledger(const LedgerInput& input,
                                                     const scenes::World& world,
                                                     std::span<const SourceFlux> sources);

// Scales each column of B and of F B so that its energy balance holds to rounding. The
// area-weighted sum of (1 - rho F) B = S is emitted + landed = absorbed + escaped. The scale
// removes the solver's defect of this sum, about its residual, and for balanced form factors their
// rounding errors, which a million reflections amplify a million times. Defects of unbalanced form
// factors remain. `radiosity` and `indirect` are the vectors that `input` views.
void close_energy(const LedgerInput& input, bool balanced, std::span<double> radiosity,
                  std::span<double> indirect);

}  // namespace earthshine::radiosity
