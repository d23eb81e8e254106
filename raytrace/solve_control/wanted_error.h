// SPDX-License-Identifier: Apache-2.0
// The wanted error of a result, its limits, and the outcome.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/surfaces/surface_error.h"
#include "scenes/effects/quality.h"
#include "scenes/scene.h"

namespace earthshine::raytrace {

struct Wanted {
  double error = 0.02;                                      // relative
  double seconds = 0.0;                                     // time limit from now() = 0; 0: none
  std::function<double()> now = {};                         // elapsed seconds
  std::function<bool(double patches, int rays)> fits = {};  // into memory; empty: always
  // Whether to end with the current result; called by many threads. Empty: never. Not with ranks.
  std::function<bool()> stop = {};
};

// The cause of an end before the wanted error. Given: a solution from a file is used unchanged.
enum class Limit { None, Time, Memory, Settings, Steps, Stopped, Ledger, Given };
[[nodiscard]] std::string limit_name(Limit limit);

// Settings and outcome of one step.
struct Step {
  std::string stage;  // "solve", "picture"
  std::size_t patches = 0;
  int form_factor_rays = 0;
  int gather_rays = 0;
  double asked = 0.0;     // target of the settings, relative
  double estimate = 0.0;  // stated error; 0: not estimated
};

struct PatchBound {
  std::size_t most = 0;
  Limit of = Limit::Steps;  // the cause of the bound: the scene's settings, memory, or neither
};

// Most patches of a solve to a wanted error: at least the current number `first`, at most
// `largest`, the scene's limit, and the number for which all ranks have memory (within 1/64).
// Queries the free memory of this moment.
[[nodiscard]] PatchBound patch_bound(const Wanted& wanted, const scenes::Quality& given,
                                     std::size_t first, std::size_t largest);

struct SteeredSolution {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;  // of the last solve
  SurfaceError surface;
  std::vector<Step> steps;
  Limit limit = Limit::None;
};

// Number of rays in all and stated error after a pass.
struct PassError {
  double rays = 0.0, error = 0.0;
};
// Whether the wanted error would take more than 16 times the rays so far, by a line through the
// logarithms of rays and errors. The fit uses all passes since an eighth of the rays, because a
// single stated error is uncertain. False if no pass ended at half of the rays or fewer.
[[nodiscard]] bool is_far_off(const std::vector<PassError>& passes, double wanted);

// Called before each solve; returns the listener for its duration, which may be empty.
using SolveListener = std::function<void(const radiosity::SolveReport&)>;

// Options of a solve for pictures of a wanted error. Pictures measure and add the residual of the
// solution, which therefore affects only their cost: patches and rays that cost about as much as
// they save. Values in `quality` stay fixed.
[[nodiscard]] radiosity::SolveOptions picture_solver(const scenes::Scene& scene,
                                                     const scenes::Quality& quality,
                                                     std::uint64_t seed);

}  // namespace earthshine::raytrace
