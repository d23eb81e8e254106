// SPDX-License-Identifier: Apache-2.0
#include "studies/orbit/condition.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "radiosity/direct/sources.h"
#include "studies/orbit/target_sources.h"

namespace earthshine::studies {

namespace {

// of each target's points, most_source_points at most
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

namespace {

// Adds the sources and their light to the outcome, which has the sights.
void find_sources(const LightBasis& basis, const scenes::RayQuery& query, const BasisView& view,
                  const SkyPlace& sky, const GroupWeights& weights, Outcome& outcome) {
  outcome.sun_share = sun_share_of(sky);
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
    outcome.targets.push_back(std::move(found));
  }
}

// Finds the reasons for those targets.
void explain(const LightBasis& basis, const BasisView& view, const SightPlan& plan,
             const base::Image& radiance, const ConditionAt& at,
             const std::optional<degrade::Setup>& cctv, const ConditionOptions& options,
             const std::vector<std::size_t>& targets, Outcome& outcome) {
  const SkyPlace& sky = basis.places()[at.place];
  std::map<std::string, base::Image> lit_by;  // the picture with a source on that is off
  for (const std::size_t t : targets) {
    std::vector<SourceOnTarget>& sources = outcome.targets[t].sources;
    for (SourceOnTarget& source : sources) {
      if (source.off != switched_off && !source.off.starts_with(dimmed_to)) continue;
      auto picture = lit_by.find(source.group);
      if (picture == lit_by.end()) {
        picture = lit_by
                      .emplace(source.group,
                               weighted_sum(view.layers, basis.groups().names,
                                            basis.weights_with(at.place, at.setting, source.group)))
                      .first;
      }
      source.when_on = &picture->second;
    }
    outcome.targets[t].why = why_not(
        {basis.scene(), *view.camera, plan, radiance, cctv, outcome.sight, sky.sun, sky.earth}, t,
        sources, options.why);
    for (SourceOnTarget& source : sources) source.when_on = nullptr;
  }
}

bool near(const std::optional<double>& a, const std::optional<double>& b, double share) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::abs(*a - *b) <= share * std::max(std::abs(*a), std::abs(*b));
}

bool same_iris(const std::optional<degrade::Exposure>& a,
               const std::optional<degrade::Exposure>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto stops = [](const degrade::Exposure& e) {
    return std::log2(e.gain / (e.f_number * e.f_number));
  };
  return std::abs(stops(*a) - stops(*b)) <= 0.25;
}

bool like(const Outcome& a, const Outcome& b, std::size_t target) {
  constexpr double of_luminance = 0.1, of_probability = 0.05, of_lit = 0.05;
  const Sight &one = a.sight.targets[target], &other = b.sight.targets[target];
  if (one.verdict != other.verdict || !same_iris(a.sight.exposure, b.sight.exposure)) return false;
  if (one.probability.has_value() != other.probability.has_value()) return false;
  for (const auto task : {&Probability::detect, &Probability::recognise, &Probability::identify}) {
    if (!one.probability) break;
    if (std::abs(*one.probability.*task - *other.probability.*task) > of_probability) return false;
  }
  const TargetOutcome &first = a.targets[target], &second = b.targets[target];
  const double lit = first.lit_fraction.value_or(0.0) - second.lit_fraction.value_or(0.0);
  return near(one.luminance, other.luminance, of_luminance) &&
         near(one.surround, other.surround, of_luminance) && std::abs(lit) <= of_lit &&
         std::equal(first.sources.begin(), first.sources.end(), second.sources.begin(),
                    second.sources.end(),
                    [](const SourceOnTarget& source, const SourceOnTarget& same) {
                      return source.group == same.group && source.off == same.off;
                    });
}

std::vector<std::size_t> targets_to_explain(const Outcome& outcome,
                                            const ConditionOptions& options) {
  std::vector<std::size_t> targets;
  for (std::size_t t = 0; t < outcome.targets.size(); ++t) {
    if (wants_reasons(outcome.sight.targets[t], options)) targets.push_back(t);
  }
  return targets;
}

// For each condition, the first one with the same weights and hence the same picture; frequent in
// eclipse.
std::vector<std::size_t> first_with_same(const std::vector<GroupWeights>& weights) {
  std::vector<std::size_t> first(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    first[k] = 0;
    while (weights[first[k]].weight != weights[k].weight) ++first[k];
  }
  return first;
}

}  // namespace

std::vector<Outcome> judge_conditions(const LightBasis& basis, const scenes::RayQuery& query,
                                      const BasisView& view,
                                      const std::vector<ConditionAt>& conditions,
                                      const std::optional<degrade::Setup>& cctv,
                                      const ConditionOptions& options) {
  std::vector<Outcome> outcomes(conditions.size());
  const auto for_each = [&](const auto& visit) {
    base::parallel_chunks(conditions.size(), 1, [&](std::size_t k, std::size_t) {
      if (options.before_each) options.before_each();
      visit(k);
    });
  };
  SightPlan plan = view.plan;
  if (cctv) place_targets(plan, *cctv);
  std::vector<GroupWeights> weights;
  for (const ConditionAt& at : conditions) {
    weights.push_back(basis.weights(at.place, at.setting, options.lamps));
  }
  const std::vector<std::size_t> same = first_with_same(weights);
  std::vector<base::Image> pictures(conditions.size());  // only for the first of equal conditions
  for_each([&](std::size_t k) {
    if (same[k] != k) return;
    pictures[k] = weighted_sum(view.layers, basis.groups().names, weights[k]);
    const std::vector<double> deviation =
        options.deviation ? options.deviation(conditions[k]) : std::vector<double>();
    outcomes[k].sight = measure_sight(plan, pictures[k], cctv, options.why.sight, deviation);
  });
  for_each([&](std::size_t k) {
    if (same[k] != k) outcomes[k].sight = outcomes[same[k]].sight;
    find_sources(basis, query, view, basis.places()[conditions[k].place], weights[k], outcomes[k]);
  });
  std::vector<std::vector<std::size_t>> to_explain(conditions.size());
  std::vector<std::optional<std::size_t>> run(view.targets.size());  // first condition of the run
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    if (k > 0 && conditions[k].setting != conditions[k - 1].setting) run.assign(run.size(), {});
    for (const std::size_t t : targets_to_explain(outcomes[k], options)) {
      if (run[t] && like(outcomes[*run[t]], outcomes[k], t)) {
        outcomes[k].targets[t].why_of = run[t];
      } else {
        to_explain[k].push_back(t);
        run[t] = k;
      }
    }
  }
  for_each([&](std::size_t k) {
    explain(basis, view, plan, pictures[same[k]], conditions[k], cctv, options, to_explain[k],
            outcomes[k]);
  });
  for (Outcome& outcome : outcomes) {
    for (std::size_t t = 0; t < outcome.targets.size(); ++t) {
      TargetOutcome& target = outcome.targets[t];
      if (target.why_of) target.why = outcomes[*target.why_of].targets[t].why;
    }
  }
  return outcomes;
}

}  // namespace earthshine::studies
