// SPDX-License-Identifier: Apache-2.0
// What is asked for where a result is to be as exact as wanted, and what came of it.
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
  double error = 0.02;               // relative, of what the budget estimates
  double seconds = 0.0;              // since `now` was 0; 0: no limit
  std::function<double()> now = {};  // seconds so far
  std::function<bool(double patches, int rays)> fits = {};  // into memory; empty: anything does
  // Whether to end with what there is, asked from many threads; empty: never. Not with ranks.
  std::function<bool()> stop = {};
};

// What stopped it before the wanted error.
// Given: a solution that was read is taken as it is.
enum class Limit { None, Time, Memory, Settings, Steps, Stopped, Ledger, Given };
[[nodiscard]] std::string limit_name(Limit limit);

// One try: what was chosen and what came of it.
struct Step {
  std::string stage;  // "solve", "picture"
  std::size_t patches = 0;
  int form_factor_rays = 0;
  int gather_rays = 0;
  double asked = 0.0;     // relative error that the settings were meant for
  double estimate = 0.0;  // found; 0: not looked at
};

struct PatchBound {
  std::size_t most = 0;
  Limit of = Limit::Steps;  // what sets it: the scene's settings, memory, or nothing of these
};

// How many patches a solve to an error may cut: no fewer than the `first` that there are, no more than `largest`, than the scene allows and, to a
// 64th, than all ranks have memory for. Asks for the memory that is free now.
[[nodiscard]] PatchBound patch_bound(const Wanted& wanted, const scenes::Quality& given,
                                     std::size_t first, std::size_t largest);

struct SteeredSolution {
  radiosity::Solution solution;
  radiosity::SolveOptions solver;  // of the last solve
  SurfaceError surface;
  std::vector<Step> steps;
  Limit limit = Limit::None;
};

// Whether a solve is to go on: what passes stated, after so many rays in all.
struct PassError {
  double rays = 0.0, error = 0.0;
};
// Whether what is left of the error takes more than 16 times the rays of all that has been done, as
// the line has it that fits the logarithms of both best since an eighth of them were cast: a single
// pass states too much or too little by chance. Passes none of which is after half of the rays or
// fewer say nothing.
[[nodiscard]] bool is_far_off(const std::vector<PassError>& passes, double wanted);

// Called before each solve; gives the listener for what the solve takes, which may be empty.
using SolveListener = std::function<void(const radiosity::SolveReport&)>;

// The solve for pictures of a wanted error. Pictures measure what a solution lacks and add it, so
// that the solution decides about their price alone: it need not be exact, only near.

// Even patches and rays that cost about as much as they save the picture; what `quality` names
// itself stays as it is.
[[nodiscard]] radiosity::SolveOptions picture_solver(const scenes::Scene& scene,
                                                     const scenes::Quality& quality,
                                                     std::uint64_t seed);

}  // namespace earthshine::raytrace
