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
  // Smaller changes of the same thing, which may suffice.
  std::vector<Change> lesser = {};
};

Reason reason_of(const Change& change, std::optional<double> probability) {
  Reason reason{change.cause, change.by, change.share, probability, change.text};
  if (probability) {
    const char* mark = change.text.find(':') == std::string::npos ? ":" : ";";
    reason.text += fmt::format("{} {} {:.2f}", mark, change.without, *probability);
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

// Tries changes for one target.
class Trials {
 public:
  Trials(const WhyNotInputs& in, std::size_t index, const Task& task, const WhyNotOptions& options)
      : in_(in),
        index_(index),
        task_(task),
        options_(options),
        start_(scenario_of(in, index, options.sight)) {}

  [[nodiscard]] double without(const std::vector<Change>& changes) const {
    return probability_of(without_all(start_, changes), task_);
  }
  [[nodiscard]] bool cures(double probability) const { return probability >= options_.wanted; }
  [[nodiscard]] bool any_cures() const {
    return std::any_of(list_.begin(), list_.end(),
                       [&](const Trial& t) { return cures(t.probability); });
  }
  [[nodiscard]] const std::vector<Trial>& list() const { return list_; }

  void add(std::vector<Change> changes) {
    for (Change& change : changes) {
      const double p = without({change});
      list_.push_back({std::move(change), p});
    }
  }
  void add(std::optional<Change> change) {
    if (change) add(std::vector<Change>{std::move(*change)});
  }
  // Adds the brightest thing with a sufficient change, in its least such change; otherwise the
  // thing that opens the iris most, or has most stray light.
  void add_bright_things() {
    std::vector<BrightThings> things = without_bright_things(in_, index_, options_.bright_things);
    for (const BrightThings& thing : things) {
      // Tries the largest change first: if it does not help, smaller ones do not either.
      if (thing.changes.size() > 1 && !cures(without({thing.changes.back()}))) continue;
      for (const Change& change : thing.changes) {
        const double p = without({change});
        if (!cures(p)) continue;
        list_.push_back({change, p});
        return;
      }
    }
    const auto most = std::max_element(
        things.begin(), things.end(),
        [](const BrightThings& a, const BrightThings& b) { return a.stops < b.stops; });
    if (most == things.end()) return;
    Change strongest = std::move(most->changes.back());
    most->changes.pop_back();
    const double p = without({strongest});
    list_.push_back({std::move(strongest), p, std::move(most->changes)});
  }

  // The causes that are needed together; no reasons if even all do not suffice.
  [[nodiscard]] WhyNot several() const {
    std::vector<Trial> needed = list_;
    if (!cures(without_these(needed))) return {};
    for (std::size_t k = needed.size(); k-- > 0;) {
      std::vector<Trial> fewer = needed;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (cures(without_these(fewer))) needed = std::move(fewer);
    }
    for (Trial& trial : needed) {
      const Trial whole = trial;
      for (const Change& lesser : whole.lesser) {
        trial.change = lesser;
        if (cures(without_these(needed))) {
          trial.probability = without({lesser});
          break;
        }
        trial.change = whole.change;
      }
    }
    std::stable_sort(needed.begin(), needed.end(), [](const Trial& a, const Trial& b) {
      return a.change.cause < b.change.cause;
    });
    WhyNot why;
    for (const Trial& trial : needed) {
      Reason reason = reason_of(trial.change, {});
      reason.probability_without = trial.probability;
      why.reasons.push_back(std::move(reason));
    }
    why.probability_without_all = without_these(needed);
    why.text = fmt::format("{}; without all of that {:.2f}", joined(why.reasons, " and "),
                           *why.probability_without_all);
    return why;
  }

 private:
  [[nodiscard]] double without_these(const std::vector<Trial>& trials) const {
    std::vector<Change> changes;
    for (const Trial& trial : trials) changes.push_back(trial.change);
    return without(changes);
  }

  const WhyNotInputs& in_;
  const std::size_t index_;
  const Task& task_;
  const WhyNotOptions& options_;
  const Scenario start_;
  std::vector<Trial> list_;
};

// The reason if no change helps.
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
  constexpr std::array<std::string_view, 13> words = {
      "out-of-view", "hidden", "black-back", "unlit",      "iris",     "glare", "saturated",
      "lag",         "blur",   "noise",      "room-light", "contrast", "small"};
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
  const std::optional<Change> back = without_black_back(in, index, sources);
  const bool mostly_back = sight.black_back >= options.sight.most_black_back;
  if (!sight.probability) {
    return only(
        mostly_back && back
            ? reason_of(*back, {})
            : Reason{Cause::Contrast, {}, {}, {}, "fills the picture: nothing to tell it from"});
  }
  const auto fails = [&](const Task& task) { return *sight.probability.*task.of < options.wanted; };
  const bool hidden = sight.verdict == Verdict::Hidden;
  const auto failing = std::find_if(tasks.begin(), tasks.end(), fails);
  if (failing == tasks.end()) {
    if (hidden && hiding) return only(reason_of(*hiding, {}));
    return mostly_back && back ? only(reason_of(*back, {})) : WhyNot();
  }
  const Task& task = *failing;
  const double now = *sight.probability.*task.of;

  Trials trials(in, index, task, options);
  trials.add(hiding);
  trials.add(back);
  trials.add(with_light(in, index, sources));
  trials.add_bright_things();
  trials.add(with_better_cctv(in, index));
  WhyNot why;
  if (!trials.any_cures()) {
    why = trials.several();
    // Limits of the viewer count only if no better picture helps.
    if (why.reasons.empty()) {
      trials.add(without_limits_of_the_eye(in, index));
      if (!trials.any_cures()) why = trials.several();
    }
  }
  const bool one_is_enough = trials.any_cures();
  const auto must = [&](const Reason& reason) {
    return (hidden && reason.cause == Cause::Hidden) ||
           (mostly_back && reason.cause == Cause::BlackBack);
  };
  const auto is_there = [&](const Reason& reason) {
    return std::any_of(why.reasons.begin(), why.reasons.end(),
                       [&](const Reason& r) { return r.cause == reason.cause; });
  };
  const bool all_needed = why.probability_without_all.has_value();
  for (const Trial& trial : trials.list()) {
    const Reason reason = reason_of(trial.change, trial.probability);
    const bool helps = one_is_enough ? trials.cures(trial.probability)
                                     : trial.probability >= now + options.least_gain;
    if (must(reason) && all_needed && !is_there(reason)) {
      why.text = reason.text + "; " + why.text;
      why.reasons.insert(why.reasons.begin(), reason);
    } else if (must(reason) ? !is_there(reason) : helps && !all_needed) {
      why.reasons.push_back(reason);
    }
  }
  if (why.reasons.empty()) why.reasons.push_back(nothing_helps(sight, sources));
  if (!all_needed || why.text.empty()) why.text = joined(why.reasons, "; ");
  why.text = task.prefix + why.text;
  return why;
}

}  // namespace earthshine::studies
