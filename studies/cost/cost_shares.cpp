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
    const bool alone = name == "ledger" || (name == "patches" && bill.solve.refinement_rays == 0);
    (alone ? cost.alone_s : cost.shared_s) += seconds;
  }
  for (const raytrace::RenderReport& report : bill.pictures) cost.shared_s += report.seconds;
  // Of a patch: what a row found; in each sweep of the balance its row and column, and its sums in
  // 16 bands; in each iteration two products.
  const auto patches = static_cast<double>(bill.solve.patches);
  const double sweeps = bill.solve.balance.sweeps;
  cost.bytes_to_all =
      patches * (64.0 + 16.0 * sweeps +
                 16.0 * static_cast<double>(columns) * double(bill.solve.iterations)) +
      24.0 * pixels;
  // The entries come once from whoever cast them; where hits are filled in, once more, with their
  // rows.
  const double filling = bill.solve.balance.filled > 0 ? 12.0 : 0.0;
  cost.bytes_dealt =
      (8.0 + filling) * static_cast<double>(bill.solve.nonzeros) + patches * 128.0 * sweeps;
  return cost;
}

double bytes_of_a_rank(const RanksCost& cost, int ranks) {
  return ranks > 1 ? cost.bytes_to_all + cost.bytes_dealt / ranks : 0.0;
}

double seconds_on_ranks(const RanksCost& cost, int ranks, double bytes_per_s) {
  return cost.alone_s + cost.shared_s / ranks + bytes_of_a_rank(cost, ranks) / bytes_per_s;
}

}  // namespace earthshine::studies
