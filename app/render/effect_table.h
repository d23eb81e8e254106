// SPDX-License-Identifier: Apache-2.0
// The table of effects of `plan` and `render --report`.
#pragma once

#include <string>
#include <vector>

#include "app/call/render_call.h"
#include "app/command.h"
#include "studies/cost/cost.h"
#include "studies/cost/memory.h"

namespace earthshine::app {

// {"effect", "runs", "why", "skipped_error"} per effect (the last for those that cannot matter),
// including the stages of the CCTV cameras as "cctv: glare".
[[nodiscard]] Json effect_rows(const LoadedScene& loaded, const RenderCall& call);

// Predicted cost of each effect.
struct Expectation {
  studies::Pilot pilot;
  std::vector<studies::EffectCost> costs;  // by effect, including the CCTV pictures
  studies::MemoryNeed memory;              // of the solve and the largest picture
};
// From a small run of the same code (studies/cost/cost.h).
[[nodiscard]] Expectation expect(const LoadedScene& loaded, const RenderCall& call,
                                 const Common& common, const scenes::RayQuery& query);

// Adds {"rays", "seconds", "memory_mib"} to the rows; effects that are not in `costs` have none.
// Appends a row for the camera rays of every picture.
void add_expectation(Json& rows, const Expectation& expected);

// The table with the actual cost of each effect in `taken`, and `expected`. cpu_seconds: of solve
// and pictures, all threads.
[[nodiscard]] Json report_json(const LoadedScene& loaded, const RenderCall& call,
                               const Expectation& expected, const radiosity::SolveReport& solved,
                               const std::vector<Picture>& pictures, const StageTimes& times,
                               double cpu_seconds);

// The report of `plan` for a scene with decided effects. ranks: of earthshine-mpi; 0: one process.
[[nodiscard]] Json plan_json(LoadedScene& loaded, const RenderCall& call, const Common& common,
                             int ranks);

// Text in columns; missing values are empty.
[[nodiscard]] std::string effect_text(const Json& rows);

}  // namespace earthshine::app
