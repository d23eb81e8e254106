// SPDX-License-Identifier: Apache-2.0
// One solution for all parts of a call: the first process to finish it stores it, and all others
// read it.
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
  bool found = false;  // made by another or an earlier process
};

// Reads `file` if it exists, or appears within the waiting time of a share. Otherwise solves and
// stores the result, unless another process was first: then reads that solution, so that all have
// the same bits on any machine. FILE.json has its digest. Throws base::Error (Input) if the digest
// differs or the file is damaged or stale, and (Work) if it is missing at a merge or the wait is
// interrupted. Ranks solve together; the first one stores it.
[[nodiscard]] SharedSolution shared_solution(const std::filesystem::path& file,
                                             const radiosity::SolutionOrigin& origin,
                                             const PartCall& part, bool quiet,
                                             const std::function<radiosity::Solution()>& solve);

// The file's name in a folder; it depends on the scene, solver settings and build.
[[nodiscard]] std::filesystem::path solution_file_in(const std::filesystem::path& folder,
                                                     const Json& scene_cache_key);

// The solver's settings for such a key.
[[nodiscard]] Json solver_cache_key(const radiosity::SolveOptions& options);

}  // namespace earthshine::app
