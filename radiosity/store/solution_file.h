// SPDX-License-Identifier: Apache-2.0
// A solution as an HDF5 file: written once, read instead of a new solve, readable by numpy.
// docs/scene-format.md lists its data sets; solution_key.h defines its validity.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/solution.h"

namespace earthshine::radiosity {

// Increased with every change of the file's layout.
inline constexpr std::uint64_t solution_format = 3;

// Input of a solution.
struct SolutionOrigin {
  const scenes::Scene& scene;
  const scenes::LightGroups& groups;
  const SolveOptions& options;
  std::string program;                        // version: other versions may give other numbers
  const scenes::Scene* first_pose = nullptr;  // whose patches these are, posed; null: of `scene`
  // Reading: gets the settings of the solve that differ from `options`; null: they are refused.
  std::vector<std::string>* other_settings = nullptr;
};

// Writes a temporary file and renames it. The same solution gives the same bytes: stage times are
// omitted. Throws base::Error as base::write_text does.
void write_solution(const std::filesystem::path& path, const Solution& solution,
                    const SolutionOrigin& origin);

// The bytes of that file.
[[nodiscard]] std::string solution_bytes(const Solution& solution, const SolutionOrigin& origin);

// Exactly the written solution, except stage times. Throws base::Error (Input) if the file is
// damaged, or if it is stale; the message then names every part that differs.
[[nodiscard]] Solution read_solution(const std::filesystem::path& path,
                                     const SolutionOrigin& origin);

}  // namespace earthshine::radiosity
