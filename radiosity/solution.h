// SPDX-License-Identifier: Apache-2.0
// The radiosity of every patch per light group, and how it was found.
//   B = M + rho (E0 + F B)      (docs/theory.md; symbols of the project's physics)
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/direct/direct.h"
#include "radiosity/direct/sources.h"
#include "radiosity/factors/form_factors.h"
#include "radiosity/patches/patches.h"
#include "scenes/effects/quality.h"
#include "scenes/effects/world.h"

namespace earthshine::radiosity {

// Adaptive cutting (refine.h). It ends at whichever of the two is reached first.
struct RefineOptions {
  bool on = false;              // off: patch_edge_m everywhere
  double start_edge_m = 0.25;   // no patch is longer
  std::size_t max_patches = 0;  // 0: as many as patch_edge_m everywhere would make
  double error = 0.0;           // estimated relative error of the radiosity, root mean square
};

struct SolveOptions {
  double patch_edge_m = 0.25;
  int form_factor_rays = 1024;  // per patch
  double tolerance = 1e-8;      // of B, relative to each right-hand side's largest (linear_solve.h)
  std::uint64_t seed = 1;
  RefineOptions refine = {};
  // Of direct light (DirectOptions), at most: shot from each lamp, and looked up on each patch.
  int flux_rays = 1 << 16;
  int direct_points = 16;
  double balance = balance_to_rounding;  // column defect at which balancing the factors ends
};

// The solver's part of the accuracy knobs.
[[nodiscard]] SolveOptions solve_options(const scenes::QualityKnobs& knobs, std::uint64_t seed);

struct RefineRound {
  std::size_t patches = 0;
  double error = 0.0;  // estimated for these patches, as RefineOptions::error
};

// Where the energy of one light group went, lm per channel.
//   given = escaped at once + lost at once + emitted + landed
//   emitted (by patches through F) + landed (directly, as computed) = absorbed + escaped
// Given is the photometric flux of lamps and emitting surfaces; of the sky only what lands is counted
// as given. What escapes at once is `escaped_at_once_lm`,
// `escaped_lm` is what does so after it was reflected or sent by a patch.
struct GroupLedger {
  std::string name;
  Rgb given_lm{0.0};            // by lamps, emitting surfaces and the sky
  Rgb escaped_at_once_lm{0.0};  // of it: by rays from lamps and sampled emitters that met nothing
  Rgb lost_at_once_lm{0.0};     // by those that met black backs
  Rgb emitted_lm{0.0};
  Rgb landed_lm{0.0};
  Rgb absorbed_lm{0.0};
  Rgb escaped_lm{0.0};
  // The worse of both equations' defects, in the worst channel: of the first over given, of the
  // second over emitted + landed.
  double imbalance = 0.0;
};

struct ObjectLight {
  std::string name;
  double area_m2 = 0.0;     // both sides of sheets, with what bodies cover of it
  Rgb illuminance_lx{0.0};  // means over the area left open, all groups together
  Rgb radiosity_lm_m2{0.0};
  double back_share = 0.0;  // of the rays that met it from exposed patches, those that met its
                            // black back: near 1 where its winding is wrong
};

struct SolveReport {
  std::size_t patches = 0;
  std::vector<RefineRound> rounds;  // of refinement, the last one for the patches solved
  std::uint64_t refinement_rays = 0;
  std::uint64_t form_factor_rays = 0;
  int rays_per_patch = 0;  // of them at least, continuations beyond mirrors left out
  std::uint64_t shadow_rays = 0;
  std::array<SourceCost, scenes::light_kinds> sources_cost{};  // by LightKind; not of a read file
  std::size_t nonzeros = 0;
  int iterations = 0;
  double residual = 0.0;      // worst relative residual over the right-hand sides
  double solver_error = 0.0;  // LinearSolve::error
  BalanceReport balance;
  double back_share = 0.0;                              // of all rays, those that met black backs
  std::vector<std::pair<std::string, double>> seconds;  // stage, wall seconds
  std::vector<GroupLedger> groups;
  std::vector<SourceFlux> sources;
  std::vector<ObjectLight> objects;
};

struct Solution {
  Patches patches;
  std::size_t columns = 0;  // 3 * groups
  // Per patch and column. `radiosity` leaves out the exitance of surfaces whose first bounce is
  // explicit (emitter_is_explicit), so that gather rays that meet them do not count that light
  // twice.
  std::vector<float> radiosity;           // lm/m^2
  std::vector<float> indirect_radiosity;  // without explicit first bounce: rho (E - E0 explicit)
  std::vector<float> direct_lx, indirect_lx;  // E0 and F B
  SolveReport report;
};

// Told how the scene is cut before its form factors are cast; may throw.
using PatchListener = std::function<void(const Patches& patches)>;

// With no light group there is nothing to solve: patches are cut, no rays are cast.
[[nodiscard]] Solution solve(const scenes::World& world, const SolveOptions& options,
                             const PatchListener& listen = {});

// In what a solve differs from the one with the same options.
struct SolveVariant {
  std::uint32_t replicate = 0;  // of the form factors: each number is an independent set of rays
  DirectOptions direct = {};    // its seed 0: that of the options
  bool know_objects = true;     // FormFactorOptions::know_objects
};
// On patches that are cut already; options.patch_edge_m and options.refine are not looked at.
[[nodiscard]] Solution solve(const scenes::World& world, const SolveOptions& options,
                             Patches patches, const SolveVariant& variant = {});

// What there is of a solution that was not come to: no light. Pictures that read it find all light
// by the paths that look for what a solution lacks.
[[nodiscard]] Solution unsolved(const scenes::LightGroups& groups);

// Whether there is any light to solve for. The ambient term is no source: it lights what the camera
// sees and bounces nowhere.
[[nodiscard]] bool is_lit(const scenes::Effects& effects);

}  // namespace earthshine::radiosity
