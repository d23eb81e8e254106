// SPDX-License-Identifier: Apache-2.0
#include "studies/condition.h"

#include <algorithm>
#include <map>

#include "scenes/sky.h"
#include "studies/target_sources.h"

namespace earthshine::studies {

BasisView make_basis_view(const LightBasis& basis, const scenes::RayQuery& query,
                          const scenes::Camera& camera, base::Image layers) {
  BasisView view;
  view.camera = &camera;
  view.layers = std::move(layers);
  const scenes::Scene& scene = basis.scene();
  ObjectMap map = object_map(view.layers);
  std::vector<TargetView> targets = find_targets(scene, camera, map);
  view.plan = plan_sight(camera, std::move(map), std::move(targets));
  for (const SightTarget& target : view.plan.targets) {
    BasisView::Target seen;
    seen.points = seen_points(scene, query, camera, view.layers.width, view.layers.height,
                              target.seen, most_source_points);
    seen.by_group = mean_by_group(view.layers, basis.groups().names, target.view.measured);
    reach_of_lamps(basis, query, seen);
    view.targets.push_back(std::move(seen));
  }
  return view;
}

Outcome judge_condition(const LightBasis& basis, const scenes::RayQuery& query,
                        const BasisView& view, std::size_t place, std::size_t setting,
                        const std::optional<degrade::Setup>& cctv,
                        const ConditionOptions& options) {
  Outcome outcome;
  const GroupWeights weights = basis.weights(place, setting, options.lamps);
  outcome.radiance = weighted_sum(view.layers, basis.groups().names, weights);
  outcome.sight = measure_sight(view.plan, outcome.radiance, cctv, options.why.sight);
  const SkyPlace& sky = basis.places()[place];
  outcome.sun_share = sun_share_of(sky);
  for (std::size_t t = 0; t < view.targets.size(); ++t) {
    const BasisView::Target& target = view.targets[t];
    TargetOutcome found;
    const TargetSources sources = sources_on(basis, query, target, weights, sky);
    found.sources = sources.sources;
    if (!target.points.empty()) found.lit_fraction = sources.lit_fraction;
    found.basis_error = basis_error(weights, target.by_group);
    if (options.explain) {
      found.why = why_not({basis.scene(), *view.camera, view.plan, outcome.radiance, cctv,
                           outcome.sight, sky.sun, sky.earth},
                          t, found.sources, options.why);
    }
    outcome.targets.push_back(std::move(found));
  }
  return outcome;
}

}  // namespace earthshine::studies
