// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "app/accuracy/stages.h"
#include "app/console.h"
#include "base/error.h"
#include "raytrace/camera/camera.h"

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
    if (!trace_references()) {
      return nothing(
          fmt::format("no light was found on what the camera sees, with {} paths a pixel",
                      2 * result_.reference_paths));
    }
    draw_straight();
    find_limits();
    climb();
    // Of what was not in the ladder nothing is said.
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

  [[nodiscard]] double time_left() const {
    if (task_.call.time_limit_s <= 0.0) return std::numeric_limits<double>::infinity();
    return task_.call.time_limit_s - parts_.seconds();
  }

  // False if all is black.
  bool trace_references() {
    std::vector<PathReference> references = new_references();
    if (!trace_first(references)) return false;
    const std::vector<int> further = further_rounds();
    const double first_seconds = parts_.seconds();
    for (std::size_t k = 0; k < further.size(); ++k) {
      const double expected = first_seconds * further[k] / first_paths;
      const bool stored = parts_.has({raytrace::PathSet::All, 0, int(k) + 1, further[k]});
      if (!stored && time_left() - expected < (1.0 - reference_share) * task_.call.time_limit_s) {
        if (std::isfinite(time_left())) break;
      }
      parts_.tell(fmt::format("reference, {} of {} rounds", k + 2, further.size() + 1),
                  expected * static_cast<double>(further.size() - k), "");
      trace_round(references, static_cast<int>(k) + 1, further[k]);
    }
    full_ = references.front().pair();
    gathered_ = references.back().pair();
    differs_ = references.size() > 1;
    result_.resolution = studies::resolution(full_, counted_);
    result_.mean_luminance = studies::mean_luminance(full_, counted_);
    return true;
  }

  void draw_straight() {
    studies::NoisyPicture* sides[] = {&straight_.first, &straight_.second};
    for (int side = 0; side < 2; ++side) {
      const CachedResult part = parts_.point(straight_step(), straight_seed(side));
      result_.reference_cpu_seconds += part.facts["cpu_seconds"].get<double>();
      const std::vector<float>& values = part.image.find("Y")->values;
      sides[side]->luminance.assign(values.begin(), values.end());
      sides[side]->variance.assign(values.size(), 0.0);  // not known; small beside the paths'
    }
  }

  void find_limits() {
    result_.limits.push_back(
        {"radiosity",
         differs_ ? studies::limit_error(gathered_, full_, counted_) : studies::PictureError{},
         differs_ ? "behind a diffuse bounce lobes reflect as if they were diffuse, and mirrors "
                    "and glass "
                    "throw no caustics"
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
      parts_.tell(fmt::format("{} of {}: {}", k + 1, ladder.size(), step.name()), left,
                  fmt::format("{:.2g} % in {}", 100.0 * result_.points.back().error.error,
                              duration(cost.wall_seconds)));
    }
  }

  ReferencePair gathered_, straight_;
  bool differs_ = false;
  std::vector<studies::AccuracyStep> ladder_;
};

}  // namespace

AccuracyResult measure_accuracy(const AccuracyTask& task) { return Study(task).run(); }
}  // namespace earthshine::app
