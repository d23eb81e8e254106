// SPDX-License-Identifier: Apache-2.0
// The light that all pictures of a call read: solved as the scene says, as exactly as --error wants
// it, within a time, or read from a file.
#pragma once

#include <functional>

#include "app/call/render_call.h"

namespace earthshine::app {

struct LightCall {
  const RenderCall& call;
  const Common& common;
  const LoadedScene& loaded;
  const scenes::RayQuery& query;
  // Where others read the same solution: called with the way to solve, where one is needed.
  std::function<radiosity::Solution(const std::function<radiosity::Solution()>&)> share = {};
};
// With what settings the call's light is solved.
[[nodiscard]] radiosity::SolveOptions solver_of(const RenderCall& call, const scenes::Scene& scene,
                                                const Common& common);
[[nodiscard]] Solved find_light(const LightCall& wanted, StageTimes& times);

// Solves until the error over the surfaces is within the scene's `quality.error`.
struct ExactCall {
  const LoadedScene& loaded;
  const Common& common;
  const scenes::RayQuery& query;
  double time_limit_s = 0.0;  // 0: none
};
[[nodiscard]] Solved solve_as_exactly(const ExactCall& call, StageTimes& times);

// Whether pictures are drawn until their own estimate is within the scene's `quality.error`.
[[nodiscard]] bool steers(const RenderCall& call, const scenes::Scene& scene);

// The wish of --error, with the limits of the call; what --max-memory or the machine has is asked
// for each number of patches.
[[nodiscard]] studies::Wanted wanted_error(const LoadedScene& loaded, const Common& common,
                                           double time_limit_s, const StageTimes& times);

}  // namespace earthshine::app
