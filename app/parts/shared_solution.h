// SPDX-License-Identifier: Apache-2.0
// One solution for all parts of a call: a file that the first process to finish it makes, whole,
// and that every other one reads.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/command.h"
#include "app/parts/part.h"
#include "radiosity/store/solution_file.h"

namespace earthshine::app {

struct SharedSolution {
  radiosity::Solution solution;
  std::string digest;  // of the file's bytes
  bool found = false;  // another process, or an earlier one, made it
};

// Reads `file` where it is there, or comes within the time that a share waits; else solves and
// keeps it there, unless another process was first: then that one's is read, so that all have the
// same bits, whatever machine found them. Beside it, FILE.json holds its digest; throws base::Error
// (Input) where that is another, or the file is damaged or stale, and (Work) where it is missing at
// a merge, or the wait is interrupted. Ranks solve together; the first keeps it.
[[nodiscard]] SharedSolution shared_solution(const std::filesystem::path& file,
                                             const radiosity::SolutionOrigin& origin,
                                             const PartCall& part, bool quiet,
                                             const std::function<radiosity::Solution()>& solve);

// The file's name in a folder: another scene, solver setting or build of the program has another.
[[nodiscard]] std::filesystem::path solution_file_in(const std::filesystem::path& folder,
                                                     const Json& scene_cache_key);

// The settings of the solver, for such a key.
[[nodiscard]] Json solver_cache_key(const radiosity::SolveOptions& options);

}  // namespace earthshine::app
