// SPDX-License-Identifier: Apache-2.0
// The solution as the commands have it: solved, or read from a file that --solution names.
#pragma once

#include <string>

#include "app/command.h"
#include "radiosity/store/solution_file.h"
#include "scenes/ray_query.h"

namespace earthshine::app {

void add_solution_option(CLI::App& command, std::string& path);

// Solves, or reads `path` when it is not empty: a file of another scene or other options is refused
// then. Adds the stages to `times` and notes what the form factors lack.
[[nodiscard]] radiosity::Solution solve_or_read(const LoadedScene& loaded,
                                                const scenes::RayQuery& query,
                                                const radiosity::SolveOptions& options,
                                                const std::string& path, StageTimes& times);

void write_solution(const std::string& path, const radiosity::Solution& solution,
                    const LoadedScene& loaded, const radiosity::SolveOptions& options);

// The same for 3D viewers, as GLB.
void write_mesh(const std::string& path, const radiosity::Solution& solution,
                const LoadedScene& loaded);

}  // namespace earthshine::app
