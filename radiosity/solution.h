// SPDX-License-Identifier: Apache-2.0
// The radiosity of every patch per light group, with a report.
//   B = M + rho (E0 + F B)      (docs/theory.md)
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
#include "radiosity/factors/kept_rows.h"
#include "radiosity/patches/patches.h"
#include "scenes/effects/quality.h"
#include "scenes/effects/world.h"

namespace earthshine::radiosity {

// Adaptive division (refine.h). Ends at the first of the two limits.
struct RefineOptions {
  bool on = false;              // false: patch_edge_m everywhere
  double start_edge_m = 0.25;   // maximum length
  std::size_t max_patches = 0;  // 0: the number of uniform patches of edge patch_edge_m
  double error = 0.0;           // estimated relative RMS error of the radiosity
};

struct SolveOptions {
  double patch_edge_m = 0.25;
  int form_factor_rays = 1024;  // per patch
  double tolerance = 1e-8;      // of B, relative to its maximum (linear_solve.h)
  std::uint64_t seed = 1;
  RefineOptions refine = {};
  // Upper limits for direct light (DirectOptions): rays from each lamp, points on each patch.
  int flux_rays = 1 << 16;
  int direct_points = 16;
  double balance = balance_to_rounding;  // column defect at which balancing the factors ends
};

// The solver's part of the accuracy settings.
[[nodiscard]] SolveOptions solve_options(const scenes::QualityKnobs& knobs, std::uint64_t seed);

struct RefineRound {
  std::size_t patches = 0;
  double error = 0.0;  // estimated for these patches, like RefineOptions::error
};

// Energy of one light group, lm per channel.
//   given = escaped at once + lost at once + emitted + landed
//   emitted (by patches through F) + landed (directly, as computed) = absorbed + escaped
// Given is the photometric flux of lamps and emitting surfaces; the sky counts with its landed
// light only. `escaped_at_once_lm` escapes directly, `escaped_lm` after reflection or emission by a
// patch.
struct GroupLedger {
  std::string name;
  Rgb given_lm{0.0};            // by lamps, emitting surfaces and the sky
  Rgb escaped_at_once_lm{0.0};  // directly: rays from lamps and sampled emitters that hit nothing
  Rgb lost_at_once_lm{0.0};     // directly: rays that hit black backs
  Rgb emitted_lm{0.0};
  Rgb landed_lm{0.0};
  Rgb absorbed_lm{0.0};
  Rgb escaped_lm{0.0};
  // The larger defect of both equations in the worst channel, relative to given in the first and to
  // emitted + landed in the second.
  double imbalance = 0.0;
};

struct ObjectLight {
  std::string name;
  double area_m2 = 0.0;     // both sides of sheets, including covered parts
  Rgb illuminance_lx{0.0};  // means over the open area, all groups together
  Rgb radiosity_lm_m2{0.0};
  double back_share = 0.0;  // share of the rays from exposed patches that hit its black back: near
                            // 1 if its winding is wrong
};

struct SolveReport {
  std::size_t patches = 0;
  std::vector<RefineRound> rounds;  // of refinement; the last one is for the solved patches
  std::uint64_t refinement_rays = 0;
  std::uint64_t form_factor_rays = 0;
  int rays_per_patch = 0;  // minimum over patches, without continuations at mirrors
  std::uint64_t shadow_rays = 0;
  std::array<SourceCost, scenes::light_kinds> sources_cost{};  // by LightKind; not stored in files
  std::size_t nonzeros = 0;
  int iterations = 0;
  double residual = 0.0;      // largest relative residual over the right-hand sides
  double solver_error = 0.0;  // LinearSolve::error
  BalanceReport balance;
  double back_share = 0.0;                              // share of all rays that hit black backs
  std::vector<std::pair<std::string, double>> seconds;  // stage, wall seconds
  std::vector<GroupLedger> groups;
  std::vector<SourceFlux> sources;
  std::vector<ObjectLight> objects;
};

struct Solution {
  Patches patches;
  std::size_t columns = 0;  // 3 * groups
  // Per patch and column. `radiosity` excludes the exitance of surfaces sampled explicitly
  // (emitter_is_explicit), so that gather rays do not count this light twice.
  std::vector<float> radiosity;               // lm/m^2
  std::vector<float> indirect_radiosity;      // without direct light: rho (E - E0 explicit)
  std::vector<float> direct_lx, indirect_lx;  // E0 and F B
  SolveReport report;
};

// Called with the patches before form factors are cast; may throw.
using PatchListener = std::function<void(const Patches& patches)>;

// Without light groups only divides patches and casts no rays.
[[nodiscard]] Solution solve(const scenes::World& world, const SolveOptions& options,
                             const PatchListener& listen = {});

// What a solve leaves for the solve of the next pose of the same scene, on posed_patches() of the
// same patches and with a ray query of the same centre: rows of form factors and samples of lamps
// that nothing that moved can have changed, and surfaces of bodies. The next solution has the bytes
// that it has without them.
struct KeptPose {
  KeptRows rows;
  KeptSamples samples;
  std::vector<Vec3> vertices;
  Vec3 centre{0.0};
  bool light_outside = false;  // scenes::has_light_outside
  std::shared_ptr<const ClosedBodies> bodies;
};

// Differences from a solve with the same options.
struct SolveVariant {
  std::uint32_t replicate = 0;  // of the form factors: each number gives an independent set of rays
  DirectOptions direct = {};    // its seed 0: the options' seed
  bool know_objects = true;     // FormFactorOptions::know_objects
  KeptPose* kept = nullptr;     // of the pose before; becomes this one's
};
// On given patches; ignores options.patch_edge_m and options.refine.
[[nodiscard]] Solution solve(const scenes::World& world, const SolveOptions& options,
                             Patches patches, const SolveVariant& variant = {});

// A solution without light. Pictures then sample all light as residual.
[[nodiscard]] Solution unsolved(const scenes::LightGroups& groups);

// Whether there is light to solve for. The ambient term is no source: it adds to visible surfaces
// and is not reflected.
[[nodiscard]] bool is_lit(const scenes::Effects& effects);

}  // namespace earthshine::radiosity
