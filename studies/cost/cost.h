// SPDX-License-Identifier: Apache-2.0
// What a run costs, effect by effect: as expected from a small run of the same code on this
// machine, and as it was.
#pragma once

#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "raytrace/render.h"
#include "scenes/effects/world.h"

namespace earthshine::studies {

// Of one solve and the pictures that read it.
struct Bill {
  radiosity::SolveReport solve;                  // patches, rays, seconds by stage
  std::vector<raytrace::RenderReport> pictures;  // rays and seconds
};

struct PilotCall : scenes::World {
  radiosity::SolveOptions solver;
  double row_entries = 0.0;  // form factors of a mean row (radiosity/factors/row_pilot.h)
};

// What the run will take. The scene is solved on coarse patches, or those that refinement starts
// from, with fewer rays. A picture of a wanted error is begun as it will be drawn and left after a
// CPU second: its rays and seconds are scaled by the squared error that is left over the wanted
// one's. Others are drawn with a thousand pixels and, unless that took long, four, each to as much
// more noise as it has fewer pixels; rays and seconds are scaled to the patches, rows and pixels of
// the run (cost_laws.h). Seconds are those of a machine that does nothing else: CPU
// seconds over threads. Of paths a few per pixel are traced. pictures: of the wanted size.
struct Pilot {
  Bill bill;
  std::vector<base::Image> pictures;        // the small ones
  double seconds = 0.0, cpu_seconds = 0.0;  // that the pilot took, wall and all threads
};
[[nodiscard]] Pilot expect_costs(const PilotCall& call,
                                 const std::vector<const scenes::Camera*>& cameras,
                                 const std::vector<raytrace::RenderOptions>& pictures);

// What a picture takes in all until the wanted error, over what its report tells of.
[[nodiscard]] double samples_growth(const raytrace::RenderReport& report, double wanted);

// An effect's part of the bill: the rays that were cast for it, and the seconds of its stages. The
// seconds of shading are shared out by rays.
struct EffectCost {
  std::string effect;  // as describe_effects() names it; "camera rays": the picture itself
  double rays = 0.0;
  double seconds = 0.0;
};
[[nodiscard]] std::vector<EffectCost> effect_costs(const Bill& bill,
                                                   const scenes::Effects& effects);
[[nodiscard]] double total_seconds(const Bill& bill);

// What ranks divide of the bill, and what every one of them does (docs/scaling.md). Of a picture's
// seconds those that each rank spends are not told apart and count as shared. bytes_to_all: values
// per patch or pixel that every rank gets; bytes_dealt: what goes to one rank each, entries of form
// factors and bands of columns' sums.
struct RanksCost {
  double shared_s = 0.0, alone_s = 0.0, bytes_to_all = 0.0, bytes_dealt = 0.0;
};
// columns: of the linear solve; pixels: of all pictures.
[[nodiscard]] RanksCost ranks_cost(const Bill& bill, std::size_t columns, double pixels);
// Every rank with its own threads, and a network of `bytes_per_s`; without its latency.
[[nodiscard]] double bytes_of_a_rank(const RanksCost& cost, int ranks);  // that come to it
[[nodiscard]] double seconds_on_ranks(const RanksCost& cost, int ranks, double bytes_per_s);

}  // namespace earthshine::studies
