// SPDX-License-Identifier: Apache-2.0
#include "studies/why/why_not.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "studies/why/sight_changes.h"

namespace earthshine::studies {
namespace {

struct Task {
  double Probability::*of;
  const char* prefix;
};
constexpr std::array<Task, 3> tasks = {{{&Probability::detect, ""},
                                        {&Probability::recognise, "not recognised: "},
                                        {&Probability::identify, "not identified: "}}};

double probability_of(const Scenario& scenario, const Task& task) {
  const CameraSight sight =
      measure_sight(scenario.plan, scenario.radiance, scenario.cctv, scenario.options);
  const std::optional<Probability>& p = sight.targets.front().probability;
  return p ? *p.*task.of : 0.0;
}

struct Trial {
  Change change;
  double probability = 0.0;
};

const char* without(Cause cause) {
  switch (cause) {
    case Cause::Unlit:
      return "with it";
    case Cause::Contrast:
      return "to an eye without one";
    case Cause::Small:
      return "if it were large";
    default:
      return "without it";
  }
}

Reason reason_of(const Change& change, std::optional<double> probability) {
  Reason reason{change.cause, change.by, change.share, probability, change.text};
  if (probability) {
    const char* mark = change.text.find(':') == std::string::npos ? ":" : ";";
    reason.text += fmt::format("{} {} {:.2f}", mark, without(change.cause), *probability);
  }
  return reason;
}

WhyNot only(Reason reason) {
  WhyNot why;
  why.text = reason.text;
  why.reasons.push_back(std::move(reason));
  return why;
}

std::string joined(const std::vector<Reason>& reasons, const char* between) {
  std::string text;
  for (const Reason& reason : reasons) text += (text.empty() ? "" : between) + reason.text;
  return text;
}

// Of the bright things the one that helps most; those together only where they help more.
void keep_best_iris(std::vector<Trial>& trials, double least_gain) {
  const auto is_iris = [](const Trial& t) { return t.change.cause == Cause::Iris; };
  const Trial* best = nullptr;
  for (const Trial& trial : trials) {
    if (!is_iris(trial)) continue;
    const bool several = trial.change.by.find(", ") != std::string::npos;
    if (best == nullptr || trial.probability > best->probability + (several ? least_gain : 0.0)) {
      best = &trial;
    }
  }
  if (best == nullptr) return;
  Trial kept = *best;
  const auto at = std::find_if(trials.begin(), trials.end(), is_iris) - trials.begin();
  trials.erase(std::remove_if(trials.begin(), trials.end(), is_iris), trials.end());
  trials.insert(trials.begin() + at, std::move(kept));
}

// Takes away what helps most, and again, until the task is done or nothing helps any more.
WhyNot several(const Scenario& start, std::vector<Trial> trials, const Task& task, double now,
               const WhyNotOptions& options) {
  Scenario scenario = start;
  for (const Trial& trial : trials) trial.change.apply(scenario);
  if (probability_of(scenario, task) < options.wanted) return {};  // not even all together
  scenario = start;
  std::vector<std::size_t> taken;
  std::vector<bool> used(trials.size(), false);
  while (now < options.wanted) {
    std::size_t best = trials.size();
    double most = now;
    for (std::size_t k = 0; k < trials.size(); ++k) {
      if (used[k]) continue;
      Scenario next = scenario;
      trials[k].change.apply(next);
      const double p = probability_of(next, task);
      if (best == trials.size() || p > most) {
        best = k;
        most = p;
      }
    }
    if (best == trials.size()) break;
    used[best] = true;
    taken.push_back(best);
    trials[best].change.apply(scenario);
    now = std::max(now, most);
  }
  WhyNot why;
  if (now < options.wanted) return why;
  // What was taken first may turn out not to be needed.
  for (std::size_t k = 0; k + 1 < taken.size();) {
    Scenario without = start;
    for (std::size_t j = 0; j < taken.size(); ++j) {
      if (j != k) trials[taken[j]].change.apply(without);
    }
    if (probability_of(without, task) < options.wanted) {
      ++k;
    } else {
      taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
  std::sort(taken.begin(), taken.end());
  for (const std::size_t k : taken) {
    Reason reason = reason_of(trials[k].change, {});
    reason.probability_without = trials[k].probability;
    why.reasons.push_back(std::move(reason));
  }
  why.probability_without_all = now;
  why.text = fmt::format("{}; without all of that {:.2f}", joined(why.reasons, " and "), now);
  return why;
}

std::vector<Change> all_changes(const WhyNotInputs& in, std::size_t index,
                                const std::vector<SourceOnTarget>& sources,
                                const WhyNotOptions& options) {
  std::vector<Change> changes;
  const auto add = [&](std::vector<Change> more) {
    std::move(more.begin(), more.end(), std::back_inserter(changes));
  };
  if (auto change = without_hiding(in, index)) changes.push_back(std::move(*change));
  add(with_light(in, index, sources));
  add(with_iris_opened(in, index, options.bright_things));
  if (auto change = without_saturation(in, index)) changes.push_back(std::move(*change));
  add(without_blur_or_noise(in));
  add(without_limits_of_the_eye(in, index));
  return changes;
}

// What is left to say where nothing helps.
Reason nothing_helps(const Sight& sight, const std::vector<SourceOnTarget>& sources) {
  Reason reason;
  std::string dark;
  bool lit = sources.empty();
  for (const SourceOnTarget& source : sources) {
    lit = lit || source.lit > 0.0;
    if (const std::string why = darkness_of(source); !why.empty()) {
      dark += (dark.empty() ? "" : ", ") + why;
    }
  }
  if (!lit && !dark.empty()) {
    reason.cause = Cause::Unlit;
    reason.share = 1.0;
    reason.text = "unlit: " + dark;
    return reason;
  }
  reason.cause = Cause::Contrast;
  reason.text = "as bright as what is round it";
  if (sight.weber) reason.text += fmt::format(" (contrast {:.1f} %)", 100.0 * *sight.weber);
  return reason;
}

}  // namespace

std::string_view word_of(Cause cause) {
  constexpr std::array<std::string_view, 9> words = {
      "out-of-view", "hidden", "unlit", "iris", "saturated", "blur", "noise", "contrast", "small"};
  return words[static_cast<std::size_t>(cause)];
}

WhyNot why_not(const WhyNotInputs& in, std::size_t index,
               const std::vector<SourceOnTarget>& sources, const WhyNotOptions& options) {
  const TargetView& view = in.plan.targets[index].view;
  const Sight& sight = in.sight.targets[index];
  if (view.pixels_alone == 0 && view.in_frame) {
    return only({Cause::Small, {}, {}, {}, "smaller than a pixel of the picture"});
  }
  if (view.pixels_alone == 0) {
    return only({Cause::OutOfView, {}, {}, {}, "out of the camera's view"});
  }
  const std::optional<Change> hiding = without_hiding(in, index);
  if (sight.pixels == 0) {
    return only(hiding ? reason_of(*hiding, {}) : Reason{Cause::Hidden, {}, 1.0, {}, "hidden"});
  }
  if (!sight.probability) {
    return only({Cause::Contrast, {}, {}, {}, "fills the picture: nothing to tell it from"});
  }
  const auto fails = [&](const Task& task) { return *sight.probability.*task.of < options.wanted; };
  const bool hidden = sight.verdict == Verdict::Hidden;
  const auto failing = std::find_if(tasks.begin(), tasks.end(), fails);
  if (failing == tasks.end()) return hidden && hiding ? only(reason_of(*hiding, {})) : WhyNot();
  const Task& task = *failing;
  const double now = *sight.probability.*task.of;

  const Scenario start = scenario_of(in, index, options.sight);
  std::vector<Trial> trials;
  for (Change& change : all_changes(in, index, sources, options)) {
    Scenario changed = start;
    change.apply(changed);
    const double probability = probability_of(changed, task);
    trials.push_back({std::move(change), probability});
  }
  keep_best_iris(trials, options.least_gain);
  const auto cures = [&](const Trial& t) { return t.probability >= options.wanted; };
  // What the viewer lacks says nothing where the picture could be better.
  const auto is_viewers = [](const Trial& t) { return t.change.cause >= Cause::Contrast; };
  if (std::any_of(trials.begin(), trials.end(),
                  [&](const Trial& t) { return cures(t) && !is_viewers(t); })) {
    trials.erase(std::remove_if(trials.begin(), trials.end(), is_viewers), trials.end());
  }
  const bool one_is_enough = std::any_of(trials.begin(), trials.end(), cures);
  WhyNot why;
  if (!one_is_enough) why = several(start, trials, task, now, options);
  for (const Trial& trial : trials) {
    if (!why.reasons.empty() && why.probability_without_all) break;
    const bool must = hidden && trial.change.cause == Cause::Hidden;
    if (must || (one_is_enough ? cures(trial) : trial.probability >= now + options.least_gain)) {
      why.reasons.push_back(reason_of(trial.change, trial.probability));
    }
  }
  if (why.reasons.empty()) why.reasons.push_back(nothing_helps(sight, sources));
  if (why.text.empty()) why.text = joined(why.reasons, "; ");
  why.text = task.prefix + why.text;
  return why;
}

}  // namespace earthshine::studies
