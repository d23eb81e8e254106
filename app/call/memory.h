// SPDX-License-Identifier: Apache-2.0
// Memory requirements: stated by `plan`, and checked before the work.
#pragma once

#include <string>

#include "app/command.h"
#include "studies/cost/memory.h"

namespace earthshine::app {

inline constexpr double mib = 1024.0 * 1024.0;

// Throws base::Error (Work) with the figures if a run needs more than the free memory. Casts a few
// rows for a better estimate only if the upper bound does not fit. If refinement ends at an error,
// the number of patches is unknown: counts the coarse division only, and check_patch_memory()
// checks later. picture: null for none; solves: false if the solution comes from a file.
void check_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                  const radiosity::SolveOptions& solver, const raytrace::RenderOptions* picture,
                  bool solves);

// Checks the solution alone, when the patches are known.
void check_patch_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                        const radiosity::SolveOptions& solver, std::size_t patches);
// Whether they fit with the fullest possible rows. states_error: of the solution, over all
// surfaces.
[[nodiscard]] bool patches_fit(const LoadedScene& loaded, const radiosity::SolveOptions& solver,
                               std::size_t patches, bool states_error);
// Checks rows that are cast one after another, `rays_per_patch` rays at a time, without a solve.
void check_row_memory(const LoadedScene& loaded, const scenes::RayQuery& query, double patch_edge_m,
                      int rays_per_patch);

[[nodiscard]] Json memory_json(const studies::MemoryNeed& need);
// "about 1.2 GiB (form factors 1.1 GiB, ...)", from memory_json(); parts below a hundredth are
// omitted.
[[nodiscard]] std::string memory_text(const Json& need);

}  // namespace earthshine::app
