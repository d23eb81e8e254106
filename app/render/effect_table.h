// SPDX-License-Identifier: Apache-2.0
// The table of effects that `plan` prints and `render --report` writes.
#pragma once

#include <string>
#include <vector>

#include "app/call/render_call.h"
#include "app/command.h"
#include "studies/cost/cost.h"
#include "studies/cost/memory.h"

namespace earthshine::app {

// {"effect", "runs", "why", "skipped_error"} per effect (the last of those that cannot matter), the
// stages of the CCTV cameras among them as "cctv: glare".
[[nodiscard]] Json effect_rows(const LoadedScene& loaded, const RenderCall& call);

// What each effect is expected to take.
struct Expectation {
  studies::Pilot pilot;
  std::vector<studies::EffectCost> costs;  // by effect, the CCTV pictures among them
  studies::MemoryNeed memory;              // of the solve and the largest picture
};
// A small run of the same code (studies/cost/cost.h).
[[nodiscard]] Expectation expect(const LoadedScene& loaded, const RenderCall& call,
                                 const Common& common, const scenes::RayQuery& query);

// Adds {"rays", "seconds", "memory_mib"} to the rows; effects that are not in `costs` take none.
// Appends a row for the camera rays, which every picture has.
void add_expectation(Json& rows, const Expectation& expected);

// The table once more with what each effect really took, in `taken` beside `expected`. cpu_seconds:
// of solve and pictures, all threads.
[[nodiscard]] Json report_json(const LoadedScene& loaded, const RenderCall& call,
                               const Expectation& expected, const radiosity::SolveReport& solved,
                               const std::vector<Picture>& pictures, const StageTimes& times,
                               double cpu_seconds);

// The report of `plan`, of a scene whose effects are decided for the call. ranks: of earthshine-mpi;
// 0: one process.
[[nodiscard]] Json plan_json(LoadedScene& loaded, const RenderCall& call, const Common& common,
                             int ranks);

// As columns; cells that a row has no value for stay empty.
[[nodiscard]] std::string effect_text(const Json& rows);

}  // namespace earthshine::app
