// SPDX-License-Identifier: Apache-2.0
// A solution as an HDF5 file: written once, read in place of another solve, opened by numpy.
// docs/scene-format.md lists its data sets; what it must agree with stands in solution_key.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Raised whenever the file's layout changes.
inline constexpr std::uint64_t solution_format = 3;

// What a solution was or would be found from.
struct SolutionOrigin {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const SolveOptions& options;
  std::string program;  // its version: another one may find other numbers
};

// Written aside and renamed. The same solution gives the same bytes: stage times are left out.
// Throws base::Error as base::write_text does.
void write_solution(const std::filesystem::path& path, const Solution& solution,
                    const SolutionOrigin& origin);

// The bytes of that file.
[[nodiscard]] std::string solution_bytes(const Solution& solution, const SolutionOrigin& origin);

// Bit for bit what was written, but for the stage times. Throws base::Error (Input) if the file is
// damaged, or stale: then the message names every part that differs.
[[nodiscard]] Solution read_solution(const std::filesystem::path& path,
                                     const SolutionOrigin& origin);

}  // namespace earthshine::radiosity
