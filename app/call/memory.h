// SPDX-License-Identifier: Apache-2.0
// Memory as the commands speak of it: stated by `plan`, refused before the work where it cannot
// fit.
#pragma once

#include <string>

#include "app/command.h"
#include "studies/cost/memory.h"

namespace earthshine::app {

inline constexpr double mib = 1024.0 * 1024.0;

// Throws base::Error (Work) with the figures when a run needs more than is free. Only where the
// most it could take would not fit are a few rows cast to know better. Where refinement ends at an
// error, its patches are not known yet: the coarse cut alone is counted, and check_patch_memory()
// looks again. picture: null for none; solves: false when the solution comes from a file.
void check_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                  const radiosity::SolveOptions& solver, const raytrace::RenderOptions* picture,
                  bool solves);

// The same for the solution alone, once the patches are cut.
void check_patch_memory(const LoadedScene& loaded, const scenes::RayQuery& query,
                        const radiosity::SolveOptions& solver, std::size_t patches);
// Whether they would fit, rows as full as they can be. states_error: of the solution, over all
// surfaces.
[[nodiscard]] bool patches_fit(const LoadedScene& loaded, const radiosity::SolveOptions& solver,
                               std::size_t patches, bool states_error);
// The same for rows cast one after another, `rays_per_patch` at a time, and not solved.
void check_row_memory(const LoadedScene& loaded, const scenes::RayQuery& query, double patch_edge_m,
                      int rays_per_patch);

[[nodiscard]] Json memory_json(const studies::MemoryNeed& need);
// "about 1.2 GiB (form factors 1.1 GiB, ...)"; parts below a hundredth are left out. Of
// memory_json().
[[nodiscard]] std::string memory_text(const Json& need);

}  // namespace earthshine::app
