// SPDX-License-Identifier: Apache-2.0
#include "app/views/sight_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/study/study.h"

namespace earthshine::app {
namespace {

Json probability_json(const std::optional<studies::Probability>& probability) {
  if (!probability) return {{"detect", Json()}, {"recognise", Json()}, {"identify", Json()}};
  return {{"detect", probability->detect},
          {"recognise", probability->recognise},
          {"identify", probability->identify}};
}

Json signal_json(const std::optional<studies::SignalSight>& signal) {
  if (!signal) return {};
  return {{"mean", signal->mean},
          {"surround", to_json(signal->surround)},
          {"weber", to_json(signal->weber)},
          {"snr", signal->snr},
          {"cnr", to_json(signal->cnr)},
          {"rose", to_json(signal->rose)},
          {"snr_d", to_json(signal->snr_d)},
          {"dprime", to_json(signal->dprime)},
          {"limiting_frequency", to_json(signal->limiting_frequency)}};
}

Json monitor_json(const std::optional<studies::MonitorSight>& monitor) {
  if (!monitor) return {};
  return {{"luminance", monitor->luminance},
          {"surround", to_json(monitor->surround)},
          {"weber", to_json(monitor->weber)},
          {"threshold", to_json(monitor->threshold)}};
}

Json eye_json(const std::optional<studies::EyeSight>& eye) {
  if (!eye) return {};
  return {{"adaptation", eye->adaptation}, {"acuity", eye->acuity},
          {"cycles", eye->cycles},         {"threshold", to_json(eye->threshold)},
          {"weber", to_json(eye->weber)},  {"probability", probability_json(eye->probability)}};
}

Json reasons_json(const studies::WhyNot& why) {
  Json reasons = Json::array();
  for (const studies::Reason& reason : why.reasons) {
    reasons.push_back({{"cause", std::string(word_of(reason.cause))},
                       {"by", reason.by.empty() ? Json() : Json(reason.by)},
                       {"share", to_json(reason.share)},
                       {"probability_without", to_json(reason.probability_without)},
                       {"text", reason.text}});
  }
  return reasons;
}

Json target_json(const studies::Sight& sight, const std::string& name,
                 const studies::TargetOutcome& outcome) {
  Json lit_by = Json::array(), light_by = Json::array();
  for (const studies::SourceOnTarget& source : outcome.sources) {
    lit_by.push_back({{"group", source.group}, {"share", source.lit}});
    light_by.push_back({{"group", source.group}, {"luminance", source.luminance}});
  }
  Json light_from = Json::array();
  for (const studies::LightShare& from : outcome.light_from) {
    light_from.push_back(
        {{"from", from.from}, {"reflected", from.reflected}, {"share", from.share}});
  }
  const bool known = outcome.basis_error.has_value();
  return {{"target", name},
          {"verdict", std::string(word_of(sight.verdict))},
          {"probability", probability_json(sight.probability)},
          {"pixels", sight.pixels},
          {"visible_fraction", to_json(sight.visible_fraction)},
          {"cut_by_frame", sight.cut_by_frame},
          {"black_back", to_json(sight.black_back)},
          {"lit_fraction", to_json(outcome.lit_fraction)},
          {"lit_by", lit_by},
          {"light_by", light_by},
          {"light_from", light_from},
          {"angle_deg", to_json(sight.angle_deg)},
          {"tv_lines", to_json(sight.tv_lines)},
          {"luminance", to_json(sight.luminance)},
          {"surround", to_json(sight.surround)},
          {"weber", to_json(sight.weber)},
          {"signal", signal_json(sight.signal)},
          {"monitor", monitor_json(sight.monitor)},
          {"eye", eye_json(sight.eye)},
          {"johnson_cycles", to_json(sight.johnson_cycles)},
          {"saturated", to_json(sight.saturated)},
          {"crushed", to_json(sight.crushed)},
          {"luminance_error", known ? Json(outcome.basis_error->rms) : Json()},
          {"luminance_bound", known ? Json(outcome.basis_error->bound) : Json()},
          {"why", outcome.why.text},
          {"reasons", reasons_json(outcome.why)}};
}

// A member of a part that may be missing.
Json within(const Json& part, const char* key) { return part.is_object() ? part.at(key) : Json(); }

}  // namespace

Json outcome_json(const studies::BasisView& view, const studies::Outcome& outcome) {
  Json targets = Json::array();
  for (std::size_t t = 0; t < outcome.targets.size(); ++t) {
    targets.push_back(
        target_json(outcome.sight.targets[t], view.plan.targets[t].view.name, outcome.targets[t]));
  }
  return targets;
}

Json flat_row(const Json& condition, const Json& result) {
  Json row = {{"scene", condition["scene"]},         {"position_deg", condition["position_deg"]},
              {"time_s", condition["time_s"]},       {"phase", condition["phase"]},
              {"sun_share", condition["sun_share"]}, {"lamps", condition["lamps"]},
              {"camera", result["camera"]},          {"target", result["target"]},
              {"verdict", result["verdict"]}};
  for (const char* task : {"detect", "recognise", "identify"}) {
    row[task] = result["probability"][task];
  }
  for (const char* key : {"pixels", "visible_fraction", "cut_by_frame", "lit_fraction", "angle_deg",
                          "tv_lines", "luminance", "surround", "weber", "johnson_cycles",
                          "saturated", "crushed", "luminance_error", "black_back"}) {
    row[key] = result[key];
  }
  for (const char* key : {"mean", "weber", "snr", "cnr", "rose", "snr_d", "dprime"}) {
    row[std::string("signal_") + key] = within(result["signal"], key);
  }
  for (const char* key : {"luminance", "weber"}) {
    row[std::string("monitor_") + key] = within(result["monitor"], key);
  }
  const Json eye = result["eye"];
  row["eye_detect"] = eye.is_object() ? eye["probability"]["detect"] : Json();
  row["why"] = result["why"];
  return row;
}

std::vector<std::string> black_back_notes(const Json& results) {
  struct Seen {
    std::string camera, target;
    int count = 0, of = 0;
    double share = 0.0;
  };
  std::vector<Seen> list;
  for (const Json& result : results) {
    if (result["black_back"].is_null()) continue;
    const std::string camera = result["camera"], target = result["target"];
    auto seen = std::find_if(list.begin(), list.end(), [&](const Seen& s) {
      return s.camera == camera && s.target == target;
    });
    if (seen == list.end()) seen = list.insert(list.end(), {camera, target});
    const double share = result["black_back"];
    ++seen->of;
    seen->count += share >= studies::SightOptions{}.most_black_back ? 1 : 0;
    seen->share = std::max(seen->share, share);
  }
  std::vector<std::string> notes;
  for (const Seen& seen : list) {
    if (seen.count == 0) continue;
    notes.push_back(fmt::format(
        "Camera {} looks at the black back of {} ({:.0f} % of what it sees, in {} of {} results): "
        "its surface has one side. How its real back looks is not known, so it counts as doubtful "
        "at best; turn it round, or give its material two_sided = true.",
        seen.camera, seen.target, 100.0 * seen.share, seen.count, seen.of));
  }
  return notes;
}

}  // namespace earthshine::app
