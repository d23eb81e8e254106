// SPDX-License-Identifier: Apache-2.0
// `study accuracy` in parts.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "app/accuracy/stages.h"
#include "app/console.h"
#include "app/parts/part.h"

namespace earthshine::app {
namespace {

using studies::Batch;

// A piece of the work that another process may do.
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
    if (!trace_first(references)) return;
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

  // Steps that read the same solution are one piece.
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

  // A step of the ladder whose memory cannot be had here is left out, as one process does.
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

void share_accuracy(const AccuracyTask& task, PartCall& part) { AccuracyShare(task).share(part); }

}  // namespace earthshine::app
