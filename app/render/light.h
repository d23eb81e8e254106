// SPDX-License-Identifier: Apache-2.0
// The light for all pictures of a call: solved with the scene's settings, to the error of --error,
// within a time limit, or read from a file.
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
  // If others share the solution: called with a function that solves, if needed.
  std::function<radiosity::Solution(const std::function<radiosity::Solution()>&)> share = {};
  // When it returns true the solve stops without a solution.
  std::function<bool()> stop = {};
};
// Settings of the solve for a call.
[[nodiscard]] radiosity::SolveOptions solver_of(const RenderCall& call, const scenes::Scene& scene,
                                                const Common& common);
[[nodiscard]] Solved find_light(const LightCall& wanted, StageTimes& times);

// Solves until the error over the surfaces is at most the scene's `quality.error`.
struct ExactCall {
  const LoadedScene& loaded;
  const Common& common;
  const scenes::RayQuery& query;
  double time_limit_s = 0.0;  // 0: none
};
[[nodiscard]] Solved solve_as_exactly(const ExactCall& call, StageTimes& times);
// For `solve`: to the scene's error, with the scene's settings, or from a file of solution.h5
// (empty: none). Throws base::Error (Work) if it does not fit into memory.
[[nodiscard]] Solved solve_alone(const ExactCall& call, const std::string& file, StageTimes& times);
// The report of `solve --json`, without the error.
[[nodiscard]] Json solve_json(const LoadedScene& loaded, const radiosity::SolveReport& report,
                              const StageTimes& times);

// Whether pictures are rendered until their own estimate is at most the scene's `quality.error`.
[[nodiscard]] bool steers(const RenderCall& call, const scenes::Scene& scene);
// If neither the call nor the scene sets an accuracy, by an error, a time or samples per pixel, the
// picture is rendered to 5 %.
void want_usual_error(const RenderCall& call, scenes::Scene& scene);

// The request of --error with the limits of the call; memory is checked for each number of patches.
[[nodiscard]] raytrace::Wanted wanted_error(const LoadedScene& loaded, const Common& common,
                                            double time_limit_s, const StageTimes& times);

// Names light groups whose flux differs from the samples' result by more than a millionth.
void note_lost_flux(const radiosity::SolveReport& report);

// The commands' solution: solved, or read from the file of --solution.

void add_solution_option(CLI::App& command, std::string& path);

// Solves, or reads `path` unless it is empty; a file of another scene or other options is an error.
// Adds the stages to `times` and notes defects of the form factors.
[[nodiscard]] radiosity::Solution solve_or_read(const LoadedScene& loaded,
                                                const scenes::RayQuery& query,
                                                const radiosity::SolveOptions& options,
                                                const std::string& path, const Common& common,
                                                StageTimes& times);

void write_solution(const std::string& path, const radiosity::Solution& solution,
                    const LoadedScene& loaded, const radiosity::SolveOptions& options);

// Writes the solution for 3D viewers, as GLB.
void write_mesh(const std::string& path, const radiosity::Solution& solution,
                const LoadedScene& loaded);

}  // namespace earthshine::app
