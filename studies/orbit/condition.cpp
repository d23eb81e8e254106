// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/condition.h"

#include <map>
#include <string>

#include "radiosity/direct/explicit_emitters.h"
#include "studies/orbit/target_sources.h"

namespace earthshine::studies {

namespace {

// Of each target's points: their number is most_source_points at most.
constexpr int rays_per_point = 8;

std::vector<LightShare> shares_of(const LightBasis& basis, const BasisView::Target& target,
                                  const std::vector<SourceOnTarget>& sources,
                                  const GroupWeights& weights, double luminance) {
  if (!(luminance > 0.0) || !target.last_bounce) return {};
  LightShares shares(basis.scene(), basis.groups());
  for (const SourceOnTarget& source : sources) shares.add(source.group, false, source.straight);
  shares.add_own(target.points, weights.weight);
  shares.add(*target.last_bounce, weights.weight);
  std::vector<LightShare> all = shares.of(luminance);
  std::erase_if(all, [](const LightShare& share) { return share.share < least_light_share; });
  return all;
}

bool wants_reasons(const Sight& sight, const ConditionOptions& options) {
  using Explain = ConditionOptions::Explain;
  if (options.explain == Explain::None || sight.verdict == Verdict::Identified) return false;
  const bool seen = sight.verdict == Verdict::Recognised || sight.verdict == Verdict::Detected;
  return options.explain == Explain::NotIdentified || !seen;
}

}  // namespace

BasisView make_basis_view(const LightBasis& basis, const scenes::RayQuery& query,
                          const scenes::Camera& camera, base::Image layers,
                          const radiosity::Solution* solution) {
  BasisView view;
  view.straight_emitters = radiosity::emitter_is_explicit(basis.scene());
  view.camera = &camera;
  view.layers = std::move(layers);
  const scenes::Scene& scene = basis.scene();
  ObjectMap map = object_map(view.layers);
  std::vector<TargetView> targets = find_targets(scene, camera, map);
  view.plan = plan_sight(camera, std::move(map), std::move(targets));
  std::optional<LastBounces> bounces;
  if (solution != nullptr) bounces.emplace(scene, basis.groups(), query, *solution);
  for (const SightTarget& target : view.plan.targets) {
    BasisView::Target seen;
    seen.points = seen_points(scene, query, camera, view.layers.width, view.layers.height,
                              target.seen, most_source_points);
    seen.by_group = mean_by_group(view.layers, basis.groups().names, target.view.measured);
    reach_of_lamps(basis, query, seen);
    if (bounces) seen.last_bounce = bounces->of(seen.points, rays_per_point);
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
  std::map<std::string, base::Image> lit_by;  // the picture with a source on that is off
  for (std::size_t t = 0; t < view.targets.size(); ++t) {
    const BasisView::Target& target = view.targets[t];
    TargetOutcome found;
    const TargetSources sources =
        sources_on(basis, query, target, view.straight_emitters, weights, sky);
    found.sources = sources.sources;
    if (!target.points.empty()) found.lit_fraction = sources.lit_fraction;
    found.basis_error = basis_error(weights, target.by_group);
    found.light_from = shares_of(basis, target, found.sources, weights,
                                 outcome.sight.targets[t].luminance.value_or(0.0));
    if (wants_reasons(outcome.sight.targets[t], options)) {
      for (SourceOnTarget& source : found.sources) {
        if (source.off != switched_off && !source.off.starts_with(dimmed_to)) continue;
        auto picture = lit_by.find(source.group);
        if (picture == lit_by.end()) {
          picture = lit_by
                        .emplace(source.group,
                                 weighted_sum(view.layers, basis.groups().names,
                                              basis.weights_with(place, setting, source.group)))
                        .first;
        }
        source.when_on = &picture->second;
      }
      found.why = why_not({basis.scene(), *view.camera, view.plan, outcome.radiance, cctv,
                           outcome.sight, sky.sun, sky.earth},
                          t, found.sources, options.why);
      for (SourceOnTarget& source : found.sources) source.when_on = nullptr;
    }
    outcome.targets.push_back(std::move(found));
  }
  return outcome;
}

}  // namespace earthshine::studies
