// SPDX-License-Identifier: Apache-2.0
// The light that all pictures of a call read: solved as the scene says, as exactly as --error wants
// it, within a time, or read from a file.
#pragma once

#include <functional>
#include <string>

#include "app/call/render_call.h"
#include "app/command.h"
#include "radiosity/store/solution_file.h"
#include "scenes/ray_query.h"

namespace earthshine::app {

struct LightCall {
  const RenderCall& call;
  const Common& common;
  const LoadedScene& loaded;
  const scenes::RayQuery& query;
  // Where others read the same solution: called with the way to solve, where one is needed.
  std::function<radiosity::Solution(const std::function<radiosity::Solution()>&)> share = {};
  // Once it says true a solve is broken off, and there is no solution.
  std::function<bool()> stop = {};
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
// For itself, as `solve` does: until the error that the scene names is reached, by the scene's
// settings, or from a file of solution.h5 (empty: none). Throws base::Error (Work) where it does
// not fit into memory.
[[nodiscard]] Solved solve_alone(const ExactCall& call, const std::string& file, StageTimes& times);
// The report of `solve --json`, without the error.
[[nodiscard]] Json solve_json(const LoadedScene& loaded, const radiosity::SolveReport& report,
                              const StageTimes& times);

// Whether pictures are drawn until their own estimate is within the scene's `quality.error`.
[[nodiscard]] bool steers(const RenderCall& call, const scenes::Scene& scene);
// A picture of which neither the call nor the scene says how exact it is to be, by an error, a time
// or samples of pixels, is drawn to 5 %.
void want_usual_error(const RenderCall& call, scenes::Scene& scene);

// The wish of --error, with the limits of the call; what --max-memory or the machine has is asked
// for each number of patches.
[[nodiscard]] raytrace::Wanted wanted_error(const LoadedScene& loaded, const Common& common,
                                            double time_limit_s, const StageTimes& times);

// Names light groups whose flux is not where samples found it, by more than a millionth.
void note_lost_flux(const radiosity::SolveReport& report);

// The solution as the commands have it: solved, or read from a file that --solution names.

void add_solution_option(CLI::App& command, std::string& path);

// Solves, or reads `path` when it is not empty: a file of another scene or other options is refused
// then. Adds the stages to `times` and notes what the form factors lack.
[[nodiscard]] radiosity::Solution solve_or_read(const LoadedScene& loaded,
                                                const scenes::RayQuery& query,
                                                const radiosity::SolveOptions& options,
                                                const std::string& path, const Common& common,
                                                StageTimes& times);

void write_solution(const std::string& path, const radiosity::Solution& solution,
                    const LoadedScene& loaded, const radiosity::SolveOptions& options);

// The same for 3D viewers, as GLB.
void write_mesh(const std::string& path, const radiosity::Solution& solution,
                const LoadedScene& loaded);

}  // namespace earthshine::app
