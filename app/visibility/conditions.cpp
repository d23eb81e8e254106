// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/console.h"
#include "app/study/json_fields.h"
#include "app/study/study.h"
#include "base/parallel.h"
#include "studies/orbit/target_sources.h"

namespace earthshine::app {
namespace {

// Conditions per stored batch: a killed run loses at most one batch.
constexpr std::size_t batch_size = 16;

std::string condition_id(const StudyPart& part, std::size_t condition) {
  return fmt::format("{}-c{}", part.id, condition);
}

std::string phase_of(double sun_share) {
  if (sun_share <= 0.0) return "eclipse";
  return sun_share < 1.0 ? "penumbra" : "day";
}

TargetFindings findings_of(const studies::Sight& sight, const studies::TargetOutcome& outcome) {
  TargetFindings found;
  found.sight = sight;
  found.lit_fraction = outcome.lit_fraction;
  const double least = studies::least_light_share * sight.luminance.value_or(0.0);
  for (const studies::SourceOnTarget& source : outcome.sources) {
    if (source.lit >= studies::least_light_share)
      found.lit_by.push_back({source.group, source.lit});
    if (source.luminance > 0.0 && source.luminance >= least) {
      found.light_by.push_back({source.group, source.luminance});
    }
  }
  found.light_from = outcome.light_from;
  if (outcome.basis_error) {
    found.luminance_error = outcome.basis_error->rms;
    found.luminance_bound = outcome.basis_error->bound;
  }
  found.why = outcome.why.text;
  found.reasons = outcome.why.reasons;
  return found;
}

studies::FinishedBy finished_by(const studies::ConditionNoise& noise,
                                const studies::CameraSight& sight, double wanted) {
  if (noise.relative && *noise.relative <= wanted) return studies::FinishedBy::Error;
  const bool sure = std::all_of(sight.targets.begin(), sight.targets.end(), [](const auto& target) {
    return target.verdict_low == target.verdict_high;
  });
  return sure ? studies::FinishedBy::Verdicts : studies::FinishedBy::Nothing;
}

using Batch = std::vector<std::vector<TargetFindings>>;

}  // namespace

studies::ConditionAt condition_at(const StudyPart& part, std::size_t condition) {
  const std::size_t places = part.basis->places().size();
  return {condition % places, condition / places};
}

double units_of_conditions(const StudyPart& part, const StudyCamera& camera) {
  return static_cast<double>(part.conditions()) * camera.columns * camera.rows;
}

std::vector<ConditionEntry> conditions_of(const StudyPart& part) {
  std::vector<ConditionEntry> conditions;
  for (std::size_t k = 0; k < part.conditions(); ++k) {
    const auto [place, setting] = condition_at(part, k);
    const studies::LampSetting& lamps = part.basis->settings()[setting];
    const studies::SkyPlace& sky = part.basis->places()[place];
    const bool along = !part.positions_deg.empty();
    const double share = studies::sun_share_of(sky);
    std::vector<Factor> factors;
    for (const auto& [name, factor] : lamps.factors) factors.push_back({name, factor});
    const std::string utc = part.moments.empty() ? "" : scenes::utc_text(part.moments[place]);
    const std::string where = along ? part.place_text(place) + ", " : "";
    conditions.push_back({condition_id(part, k), part.scene, where + "lamps " + lamps.name,
                          lamps.name, utc, along ? Number(part.positions_deg[place]) : Number(),
                          along ? Number(part.times_s[place]) : Number(),
                          sky.sun ? Number(share) : Number(), sky.sun ? phase_of(share) : "",
                          std::move(factors), lamps.others_off ? "off" : "as-they-are", Number(),
                          part.pose});
  }
  return conditions;
}

StudyConditions::StudyConditions(const StudyPart& part, const studies::StudyFile& study,
                                 const ResultCache& store, const Common& common)
    : part_(part), study_(study), common_(common), store_(store) {}

studies::ConditionOptions StudyConditions::options() const {
  studies::ConditionOptions options;
  options.before_each = Interrupt::leave_if_asked;
  options.why.wanted = study_.seen_probability;
  options.why.sight.seen_probability = study_.seen_probability;
  using Explain = studies::ConditionOptions::Explain;
  options.explain = part_.conditions() > 1 ? Explain::Unseen : Explain::NotIdentified;
  return options;
}

Json StudyConditions::cache_key(const StudyCamera& camera, const Json& frame_cache_key,
                                std::size_t first, std::size_t last) const {
  Json cache_key = {{"what", "conditions"}, {"picture", frame_cache_key}};
  Json& weights = cache_key["weights"] = Json::array();
  for (std::size_t k = first; k < last; ++k) {
    const auto [place, setting] = condition_at(part_, k);
    const studies::GroupWeights found = part_.basis->weights(place, setting);
    Json one = Json::array();
    for (const Rgb& weight : found.weight) one.push_back(to_json(weight));
    const studies::SkyPlace& sky = part_.basis->places()[place];
    if (sky.sun) one.push_back(to_json(sky.sun->direction));
    if (sky.earth) one.push_back(to_json(sky.earth->direction));
    weights.push_back(one);
  }
  if (camera.cctv) {
    cache_key["cctv"] = settings_json(camera.cctv->chain.camera);
    cache_key["monitor"] = monitor_json(camera.cctv->chain.monitor);
  }
  // Motion blurs targets. Reasons name objects, and explained details depend on their number.
  const auto motion_key = [](const scenes::Motion& motion) {
    return Json{to_json(motion.velocity_m_s), to_json(motion.spin_deg_s)};
  };
  cache_key["motion"] = motion_key(camera.camera->motion);
  for (const scenes::Object& object : part_.loaded.scene.objects) {
    cache_key["objects"].push_back({object.name, motion_key(object.motion)});
    if (object.spin_about) cache_key["objects"].push_back(to_json(*object.spin_about));
  }
  cache_key["explain"] = static_cast<int>(options().explain);
  cache_key["targets"] = part_.targets;
  cache_key["seen"] = study_.seen_probability;
  return cache_key;
}

std::optional<Judged> StudyConditions::find(const StudyCamera& camera,
                                            const Json& frame_cache_key) const {
  Judged all;
  for (std::size_t batch = 0; batch < batches(); ++batch) {
    const auto [first, last] = conditions_of(batch);
    std::string said;
    const auto stored = store_.find_facts(cache_key(camera, frame_cache_key, first, last), said);
    if (!stored) return std::nullopt;
    for (auto& one : read_kept<Batch>((*stored)["conditions"])) all.emplace_back(std::move(one));
  }
  return all;
}

std::size_t StudyConditions::batches() const {
  return (part_.conditions() + batch_size - 1) / batch_size;
}

Share StudyConditions::conditions_of(std::size_t batch) const {
  return {batch * batch_size, std::min((batch + 1) * batch_size, part_.conditions())};
}

bool StudyConditions::has(const StudyCamera& camera, const Json& frame_cache_key,
                          std::size_t batch) const {
  const auto [first, last] = conditions_of(batch);
  return store_.has(cache_key(camera, frame_cache_key, first, last));
}

Judged StudyConditions::judge(const StudyCamera& camera, const studies::BasisView& view,
                              const StudyFrames::Frame& frame, const Json& frame_cache_key,
                              Share batches, std::vector<StudyCost>& costs) {
  const auto start = std::chrono::steady_clock::now();
  const raytrace::Progress progress =
      common_.progress->begin(fmt::format("conditions of camera {}", camera.camera->name),
                              Work::Conditions, units_of_conditions(part_, camera));
  std::optional<degrade::Setup> cctv;
  if (camera.cctv) cctv = camera.cctv->chain;
  Judged all(part_.conditions());
  const double wanted = StudyFrames::wanted_error(part_.basis_scene.scene);
  bool found = true;
  for (std::size_t batch = batches.first; batch < batches.last; ++batch) {
    const std::size_t first = conditions_of(batch).first, last = conditions_of(batch).last;
    if (progress) progress(first, all.size());
    const Json key = cache_key(camera, frame_cache_key, first, last);
    std::string said;
    if (const std::optional<Json> stored = store_.find_facts(key, said)) {
      Batch kept = read_kept<Batch>((*stored)["conditions"]);
      std::move(kept.begin(), kept.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
      continue;
    }
    if (!said.empty()) note("note: " + said);
    found = false;
    if (Interrupt::asked()) break;
    std::vector<studies::ConditionAt> conditions;
    for (std::size_t k = first; k < last; ++k) conditions.push_back(condition_at(part_, k));
    std::vector<studies::Outcome> outcomes;
    studies::ConditionOptions how = options();
    how.deviation = [&](const studies::ConditionAt& at) {
      return frame.deviations(part_.basis->weights(at.place, at.setting));
    };
    try {
      outcomes = studies::judge_conditions(*part_.basis, *part_.query, view, conditions, cctv, how);
    } catch (const Interrupt::Left&) {
      break;
    }
    Batch batch_found(last - first);
    for (std::size_t k = first; k < last; ++k) {
      const studies::Outcome& outcome = outcomes[k - first];
      const auto [place, setting] = condition_at(part_, k);
      studies::ConditionNoise noise = frame.noise_of(part_.basis->weights(place, setting));
      noise.finished_by = finished_by(noise, outcome.sight, wanted);
      for (std::size_t t = 0; t < outcome.targets.size(); ++t) {
        TargetFindings target = findings_of(outcome.sight.targets[t], outcome.targets[t]);
        target.noise = noise;
        if (const auto& of = outcome.targets[t].why_of) {
          target.why_of = condition_id(part_, first + *of);
        }
        batch_found[k - first].push_back(std::move(target));
      }
      all[k] = batch_found[k - first];
    }
    store_.keep_facts(key, {{"conditions", kept_json(batch_found)}});
  }
  const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
  costs.push_back(
      {fmt::format("conditions {} {}", part_.id, camera.camera->name), gone.count(), 0, found});
  return all;
}

}  // namespace earthshine::app
