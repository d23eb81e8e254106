// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "app/accuracy/parts.h"
#include "app/console.h"
#include "app/parts/part.h"
#include "base/error.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

using studies::Batch;
using studies::ReferencePair;

constexpr double reference_share = 0.5;  // of a time limit

class Study : AccuracyStages {
 public:
  explicit Study(const AccuracyTask& task) : AccuracyStages(task) {}

  AccuracyResult run() {
    if (const std::string why = nothing_to_measure(); !why.empty()) return nothing(why);
    if (const std::string why = trace_references(); !why.empty()) return nothing(why);
    draw_straight();
    find_limits();
    climb();
    // Removes methods that are not in the ladder.
    std::erase_if(result_.limits, [this](const MethodLimit& limit) {
      return std::none_of(ladder_.begin(), ladder_.end(), [&](const studies::AccuracyStep& step) {
        return step.method == limit.method;
      });
    });
    result_.findings =
        studies::find_accuracy(result_.points, task_.call.wanted, result_.resolution);
    return std::move(result_);
  }

 private:
  AccuracyResult nothing(const std::string& why) {
    result_.nothing = why;
    return std::move(result_);
  }

  // Seconds of that work that the time limit allows.
  [[nodiscard]] double in_time(double seconds) const {
    return std::min(seconds, std::max(0.0, time_left()));
  }
  [[nodiscard]] double time_left() const {
    if (task_.call.time_limit_s <= 0.0) return std::numeric_limits<double>::infinity();
    return task_.call.time_limit_s - parts_.seconds();
  }

  // Reason why there is nothing to measure; "": there is something.
  std::string trace_references() {
    std::vector<PathReference> references = new_references();
    if (std::string why = trace_first(references); !why.empty()) return why;
    const std::vector<int> further = further_rounds();
    const double first_seconds = parts_.seconds();
    for (std::size_t k = 0; k < further.size(); ++k) {
      const double expected = first_seconds * further[k] / first_paths;
      const bool stored = parts_.has({raytrace::PathSet::All, 0, int(k) + 1, further[k]});
      if (!stored && time_left() - expected < (1.0 - reference_share) * task_.call.time_limit_s) {
        if (std::isfinite(time_left())) break;
      }
      const double rest = expected * static_cast<double>(further.size() - k);
      // About as long as the references take the settings that are measured by them.
      task_.common.progress->expect_rest(
          in_time(rest + reference_share * (parts_.seconds() + rest)));
      parts_.note_progress(fmt::format("reference, {} of {} rounds", k + 2, further.size() + 1),
                           in_time(rest), "");
      trace_round(references, static_cast<int>(k) + 1, further[k]);
    }
    take_truth(references.front());
    gathered_ = references.back().pair();
    differs_ = references.size() > 1;
    result_.resolution = studies::resolution(full_, counted_);
    result_.mean_luminance = studies::mean_luminance(full_, counted_);
    return "";
  }

  void draw_straight() {
    studies::NoisyPicture* sides[] = {&straight_.first, &straight_.second};
    for (int side = 0; side < 2; ++side) {
      const CachedResult part = parts_.point(straight_step(), straight_seed(side));
      result_.reference_cpu_seconds += part.facts["cpu_seconds"].get<double>();
      const std::vector<float>& values = part.image.find("Y")->values;
      sides[side]->luminance.assign(values.begin(), values.end());
    }
  }

  void find_limits() {
    result_.limits.push_back(
        {"radiosity",
         differs_ ? studies::limit_error(gathered_, full_, counted_) : studies::PictureError{},
         differs_
             ? "curved mirrors, two mirrors in turn and glass that bends light throw no caustics"
             : "none: without lobes, mirrors and glass it comes to what paths come to"});
    const studies::PictureError straight = studies::limit_error(straight_, full_, counted_);
    result_.limits.push_back({"direct", straight, "leaves out the light between surfaces"});
    result_.limits.push_back({"distributed", straight, "leaves out the light between surfaces"});
    result_.limits.push_back({"paths", {}, "none: its only error is noise"});
  }

  const ReferencePair& limit_of(const studies::AccuracyStep& step) const {
    if (step.method == "radiosity") return gathered_;
    return step.method == "paths" ? full_ : straight_;
  }

  void climb() {
    ladder_ = make_ladder();
    const std::vector<studies::AccuracyStep>& ladder = ladder_;
    parts_.expect(ladder);
    std::vector<studies::Taken> taken;
    std::vector<bool> stored;
    for (const studies::AccuracyStep& step : ladder) {
      stored.push_back(parts_.has(step, task_.view.seed));
    }
    for (std::size_t k = 0; k < ladder.size(); ++k) {
      const studies::AccuracyStep& step = ladder[k];
      if (!stored[k]) {
        const double expected = parts_.wall_per_cpu() * studies::expected_seconds(step, taken);
        if (expected > time_left() || time_left() <= 0.0) {
          result_.not_run.push_back(
              {step.name(), fmt::format("would take about {}, and the time limit leaves {}",
                                        duration(expected), duration(std::max(0.0, time_left())))});
          continue;
        }
        const bool merges = task_.call.part.task == PartCall::Task::Merge;
        const std::string unfit = merges ? parts_.left_out(step) : parts_.does_not_fit(step);
        if (!unfit.empty()) {
          result_.not_run.push_back({step.name(), unfit});
          continue;
        }
      }
      const CachedResult part = parts_.point(step, task_.view.seed);
      const studies::StepCost cost = parts_.cost_of(part.facts);
      const std::vector<float>& luminance = part.image.find("Y")->values;
      result_.points.push_back({step, cost, studies::picture_error(luminance, full_, counted_),
                                studies::picture_error(luminance, limit_of(step), counted_)});
      taken.push_back({step, cost.cpu_seconds});
      double left = 0.0;
      for (std::size_t j = k + 1; j < ladder.size(); ++j) {
        if (!stored[j]) {
          left += parts_.wall_per_cpu() * studies::expected_seconds(ladder[j], taken);
        }
      }
      task_.common.progress->expect_rest(in_time(left));
      parts_.note_progress(
          fmt::format("{} of {}: {}", k + 1, ladder.size(), step.name()), in_time(left),
          fmt::format("{} in {}", scenes::percent(result_.points.back().error.error),
                      duration(cost.wall_seconds)));
    }
  }

  ReferencePair gathered_, straight_;
  bool differs_ = false;
  std::vector<studies::AccuracyStep> ladder_;
};

// `study accuracy` in parts.

// A unit of work for another process.
struct AccuracyPiece {
  std::string name;
  std::function<bool()> is_done;
  std::function<void()> work;
};

class AccuracyShare : AccuracyStages {
 public:
  explicit AccuracyShare(const AccuracyTask& task) : AccuracyStages(task) {}

  void share(PartCall& part) {
    using Task = PartCall::Task;
    ladder_ = make_ladder();
    parts_.expect(ladder_);
    join_parts(std::filesystem::path(task_.call.folder) / points_folder, task_.common,
               parts_.digests(ladder_), part);
    if (part.task == Task::Solve || !nothing_to_measure().empty()) return;
    std::vector<PathReference> references = new_references();
    std::vector<MissingWork> missing;
    for (const AccuracyPiece& piece : pieces_of_round(references, 0, first_paths)) {
      if (part.task == Task::Merge && !piece.is_done()) missing.push_back({piece.name, 1});
    }
    if (!missing.empty()) refuse_to_merge(task_.call.folder, missing);
    if (!trace_first(references).empty()) return;
    std::vector<AccuracyPiece> pieces;
    const std::vector<int> further = further_rounds();
    for (std::size_t k = 0; k < further.size(); ++k) {
      append(pieces, pieces_of_round(references, static_cast<int>(k) + 1, further[k]));
    }
    append(pieces, pieces_of_steps());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const std::size_t owner = k % std::max<std::size_t>(1, part.count) + 1;
      if (part.task == Task::Share && owner == part.number) pieces[k].work();
      if (part.task == Task::Merge && !pieces[k].is_done()) {
        missing.push_back({pieces[k].name, owner});
      }
    }
    if (!missing.empty()) refuse_to_merge(task_.call.folder, missing);
    if (part.number <= pieces.size() || task_.common.quiet) return;
    note(fmt::format("part {} of {}: nothing to do: the study has {} pieces", part.number,
                     part.count, pieces.size()));
  }

 private:
  static void append(std::vector<AccuracyPiece>& pieces, std::vector<AccuracyPiece> more) {
    pieces.insert(pieces.end(), more.begin(), more.end());
  }

  std::vector<AccuracyPiece> pieces_of_round(const std::vector<PathReference>& references,
                                             int index, int paths) {
    std::vector<AccuracyPiece> pieces;
    for (const PathReference& reference : references) {
      for (int side = 0; side < 2; ++side) {
        const Batch batch{reference.paths, side, index, paths};
        pieces.push_back({fmt::format("reference {}, round {}", side + 1, index + 1),
                          [this, batch] { return parts_.has(batch); },
                          [this, batch] { (void)parts_.batch(batch); }});
      }
    }
    return pieces;
  }

  // Steps that read the same solution form one unit.
  std::vector<AccuracyPiece> pieces_of_steps() {
    std::vector<std::pair<std::vector<studies::AccuracyStep>, std::uint64_t>> groups;
    for (int side = 0; side < 2; ++side) {
      groups.push_back({{straight_step()}, straight_seed(side)});
    }
    const std::size_t steps_from = groups.size();
    const auto solver = [this](const studies::AccuracyStep& step) {
      return studies::solver_of(scene_, step, task_.view.seed);
    };
    const auto reads_alone = [](const studies::AccuracyStep& step) {
      return step.indirect != raytrace::Indirect::Radiosity || step.steered();
    };
    for (const studies::AccuracyStep& step : ladder_) {
      const auto like = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(steps_from),
                                     groups.end(), [&](auto& group) {
                                       const studies::AccuracyStep& other = group.first.front();
                                       return !reads_alone(step) && !reads_alone(other) &&
                                              studies::same_solver(solver(other), solver(step));
                                     });
      if (like != groups.end()) {
        like->first.push_back(step);
      } else {
        groups.push_back({{step}, task_.view.seed});
      }
    }
    std::vector<AccuracyPiece> pieces;
    for (const auto& [steps, seed] : groups) {
      pieces.push_back({steps.front().name(),
                        [this, steps = steps, seed = seed] {
                          return std::all_of(steps.begin(), steps.end(), [&](const auto& step) {
                            return parts_.has(step, seed) ||
                                   (seed == task_.view.seed && !parts_.left_out(step).empty());
                          });
                        },
                        [this, steps = steps, seed = seed] {
                          for (const auto& step : steps) take_step(step, seed);
                        }});
    }
    return pieces;
  }

  // A step of the ladder that does not fit into memory is skipped, as in a single process.
  void take_step(const studies::AccuracyStep& step, std::uint64_t seed) {
    const bool may_be_left_out = seed == task_.view.seed && !parts_.has(step, seed);
    const std::string unfit = may_be_left_out ? parts_.does_not_fit(step) : "";
    if (unfit.empty()) {
      (void)parts_.point(step, seed);
    } else {
      parts_.leave_out(step, unfit);
    }
  }

  std::vector<studies::AccuracyStep> ladder_;
};

}  // namespace

AccuracyResult measure_accuracy(const AccuracyTask& task) { return Study(task).run(); }

void share_accuracy(const AccuracyTask& task, PartCall& part) { AccuracyShare(task).share(part); }

}  // namespace earthshine::app
