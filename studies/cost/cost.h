// SPDX-License-Identifier: Apache-2.0
// The cost of a run, effect by effect: predicted from a small run of the same code on this machine,
// and measured.
#pragma once

#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/effects/world.h"

namespace earthshine::studies {

// Cost of one solve and the pictures that read it.
struct Bill {
  radiosity::SolveReport solve;                  // patches, rays, seconds by stage
  std::vector<raytrace::RenderReport> pictures;  // rays and seconds
};

struct PilotCall : scenes::World {
  radiosity::SolveOptions solver;
  double row_entries = 0.0;  // form factors of a mean row (radiosity/factors/row_pilot.h)
};

// Predicts the cost of the run. Solves the scene on coarse patches, or the first patches of
// refinement, with fewer rays. A picture with a wanted error is drawn for 2 CPU seconds; its rays
// and seconds are scaled by the remaining squared error over the wanted one. Other pictures are
// drawn with a thousand pixels and, if that is fast, with four thousand, with noise scaled to their
// pixels. Their rays and seconds are scaled to the patches, rows and pixels of the run
// (cost_laws.h). Seconds are those of an idle machine: CPU seconds over threads. For paths, traces
// a few per pixel. pictures: of the wanted size.
struct Pilot {
  Bill bill;
  std::vector<base::Image> pictures;        // the small ones
  double seconds = 0.0, cpu_seconds = 0.0;  // of the pilot, wall clock and all threads
};
[[nodiscard]] Pilot expect_costs(const PilotCall& call,
                                 const std::vector<const scenes::Camera*>& cameras,
                                 const std::vector<raytrace::RenderOptions>& pictures);

// Predicted ratio of the samples for the wanted error to the samples in the report.
[[nodiscard]] double samples_growth(const raytrace::RenderReport& report, double wanted);

// An effect's part of the bill: its rays, and the seconds of its stages. Seconds of shading are
// divided by rays.
struct EffectCost {
  std::string effect;  // from describe_effects(); "camera rays": the picture itself
  double rays = 0.0;
  double seconds = 0.0;
};
[[nodiscard]] std::vector<EffectCost> effect_costs(const Bill& bill,
                                                   const scenes::Effects& effects);
[[nodiscard]] double total_seconds(const Bill& bill);

// The parts of the bill that ranks divide, and that each rank repeats (docs/scaling.md). The
// seconds of a picture count as divided, although each rank repeats some. bytes_to_all: values per
// patch or pixel for every rank. bytes_dealt: data for one rank each, entries of form factors and
// sums of columns.
struct RanksCost {
  double shared_s = 0.0, alone_s = 0.0, bytes_to_all = 0.0, bytes_dealt = 0.0;
};
// columns: of the linear solve; pixels: of all pictures.
[[nodiscard]] RanksCost ranks_cost(const Bill& bill, std::size_t columns, double pixels);
// Every rank has its own threads, on a network of `bytes_per_s` without latency.
[[nodiscard]] double bytes_of_a_rank(const RanksCost& cost, int ranks);  // received by one rank
[[nodiscard]] double seconds_on_ranks(const RanksCost& cost, int ranks, double bytes_per_s);

}  // namespace earthshine::studies
