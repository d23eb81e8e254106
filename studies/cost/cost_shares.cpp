// SPDX-License-Identifier: Apache-2.0
// The bill, shared out among the effects.
#include <algorithm>

#include "studies/cost/cost.h"

namespace earthshine::studies {
namespace {

double solve_seconds(const radiosity::SolveReport& report) {
  double sum = 0.0;
  for (const auto& [name, seconds] : report.seconds) sum += seconds;
  return sum;
}

}  // namespace

std::vector<EffectCost> effect_costs(const Bill& bill, const scenes::Effects& effects) {
  EffectCost between{"interreflection"}, glossy{"glossy reflection"}, mirror{"mirror"},
      refraction{"refraction"}, layers{"layers"}, camera{"camera rays"};
  std::vector<EffectCost> sources;
  for (std::size_t k = 0; k < scenes::light_kinds; ++k) {
    const radiosity::SourceCost& cost = bill.solve.sources_cost[k];
    sources.push_back({std::string(scenes::effect_of(static_cast<scenes::LightKind>(k))),
                       static_cast<double>(cost.rays), cost.seconds});
  }
  between.rays = static_cast<double>(bill.solve.refinement_rays + bill.solve.form_factor_rays);
  for (const auto& [name, seconds] : bill.solve.seconds) {
    if (name != "direct light") between.seconds += seconds;
  }
  for (const raytrace::RenderReport& report : bill.pictures) {
    const raytrace::RayCounts& rays = report.rays;
    // Without light between surfaces the hemisphere is searched for the Earth alone.
    EffectCost& gathers = effects.interreflection
                              ? between
                              : sources[static_cast<std::size_t>(scenes::LightKind::Earth)];
    gathers.rays += static_cast<double>(rays.gather);
    gathers.seconds += report.gather_seconds;
    // Paths have no gather stage of their own: all their rays share the seconds.
    const double apart = report.gather_seconds > 0.0 ? static_cast<double>(rays.gather) : 0.0;
    const double shaded = std::max(1.0, static_cast<double>(rays.total()) - apart);
    const double per_ray = std::max(0.0, report.seconds - report.gather_seconds) / shaded;
    if (apart == 0.0) gathers.seconds += per_ray * static_cast<double>(rays.gather);
    const auto take = [per_ray](EffectCost& cost, std::uint64_t count) {
      cost.rays += static_cast<double>(count);
      cost.seconds += per_ray * static_cast<double>(count);
    };
    for (std::size_t k = 0; k < scenes::light_kinds; ++k) take(sources[k], rays.to_light[k]);
    take(glossy, rays.lobe);
    take(mirror, rays.mirror);
    take(refraction, rays.refraction);
    take(layers, rays.layers);
    take(camera, rays.camera + rays.planning);
  }
  std::vector<EffectCost> costs = {between, glossy, mirror, refraction, layers, camera};
  costs.insert(costs.end(), sources.begin(), sources.end());
  return costs;
}

double total_seconds(const Bill& bill) {
  double sum = solve_seconds(bill.solve);
  for (const raytrace::RenderReport& report : bill.pictures) sum += report.seconds;
  return sum;
}

RanksCost ranks_cost(const Bill& bill, std::size_t columns, double pixels) {
  RanksCost cost;
  for (const auto& [name, seconds] : bill.solve.seconds) {
    // Cutting into patches is each rank's own; the looks of refinement are shared.
    const bool alone = name == "balance" || name == "ledger" ||
                       (name == "patches" && bill.solve.refinement_rays == 0);
    (alone ? cost.alone_s : cost.shared_s) += seconds;
  }
  for (const raytrace::RenderReport& report : bill.pictures) cost.shared_s += report.seconds;
  const double exchanged = static_cast<double>(bill.solve.patches) * static_cast<double>(columns);
  cost.bytes = 8.0 * static_cast<double>(bill.solve.nonzeros) +
               8.0 * exchanged * bill.solve.iterations + 24.0 * pixels;
  return cost;
}

double seconds_on_ranks(const RanksCost& cost, int ranks, double bytes_per_s) {
  return cost.alone_s + cost.shared_s / ranks + (ranks > 1 ? cost.bytes / bytes_per_s : 0.0);
}

}  // namespace earthshine::studies
