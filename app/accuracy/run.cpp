// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "app/accuracy/parts.h"
#include "app/console.h"
#include "base/error.h"
#include "raytrace/camera/camera.h"

namespace earthshine::app {
namespace {

using studies::Batch;
using studies::ReferencePair;

constexpr int first_paths = 16;      // per pixel and side, before it is known how many are needed
constexpr int most_paths = 1 << 14;  // per pixel and side
constexpr double reference_share = 0.5;  // of a time limit

// Both sides of a reference, batch by batch.
struct PathReference {
  raytrace::PathSet paths = raytrace::PathSet::All;
  std::vector<Batch> batches[2];
  std::vector<base::Image> pictures[2];

  [[nodiscard]] ReferencePair pair() const {
    return {studies::mean_of_batches(batches[0], pictures[0]),
            studies::mean_of_batches(batches[1], pictures[1])};
  }
};

class Study {
 public:
  explicit Study(const AccuracyTask& task)
      : task_(task),
        scene_{task.loaded.scene, task.loaded.groups, task.loaded.effects, task.query},
        parts_(task, scene_) {}

  AccuracyResult run() {
    const raytrace::CameraModel camera =
        raytrace::make_camera_model(task_.view.camera, task_.view.columns, task_.view.rows);
    if (task_.loaded.groups.count() == 0 &&
        base::max_component(task_.loaded.scene.ambient_radiance) <= 0.0) {
      return nothing("nothing gives light: the picture is black, and has no error");
    }
    counted_ = studies::surface_pixels(scene_, camera);
    result_.pixels = std::size_t(std::count(counted_.begin(), counted_.end(), true));
    if (result_.pixels == 0) {
      return nothing("no pixel shows a surface that is no source: there is nothing to compare");
    }
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

  // One batch on both sides of every reference, so that a time limit leaves them alike.
  void trace_round(std::vector<PathReference>& references, int index, int paths) {
    for (PathReference& reference : references) {
      for (int side = 0; side < 2; ++side) {
        const Batch batch{reference.paths, side, index, paths};
        CachedResult part = parts_.batch(batch);
        result_.reference_cpu_seconds += part.facts["cpu_seconds"].get<double>();
        reference.batches[side].push_back(batch);
        reference.pictures[side].push_back(std::move(part.image));
      }
    }
    result_.reference_paths += paths;
  }

  // False if all is black.
  bool trace_references() {
    const double finest = *std::min_element(task_.call.wanted.begin(), task_.call.wanted.end());
    result_.wanted_resolution = finest / task_.call.reference_factor;
    std::vector<PathReference> references(1);
    if (studies::leaves_paths_out(task_.loaded.effects)) {
      references.push_back({raytrace::PathSet::NoCaustics, {}, {}});
    }
    trace_round(references, 0, first_paths);
    full_ = references.front().pair();
    if (!(studies::mean_luminance(full_, counted_) > 0.0)) return false;
    const std::vector<int> further = studies::further_batches(
        first_paths, studies::resolution(full_, counted_), result_.wanted_resolution, most_paths);
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
    const double finest = *std::min_element(task_.call.wanted.begin(), task_.call.wanted.end());
    const studies::AccuracyStep step = studies::straight_step(task_.loaded.scene, finest);
    studies::NoisyPicture* sides[] = {&straight_.first, &straight_.second};
    for (int side = 0; side < 2; ++side) {
      const CachedResult part =
          parts_.point(step, studies::reference_seed(task_.view.seed, side, most_paths));
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
    studies::LadderOptions options = task_.call.ladder;
    options.finest = *std::min_element(task_.call.wanted.begin(), task_.call.wanted.end());
    ladder_ = studies::accuracy_ladder(task_.loaded.scene, task_.loaded.effects, options);
    const std::vector<studies::AccuracyStep>& ladder = ladder_;
    parts_.expect(ladder);
    std::vector<studies::Taken> taken;
    for (std::size_t k = 0; k < ladder.size(); ++k) {
      const studies::AccuracyStep& step = ladder[k];
      if (!parts_.has(step, task_.view.seed)) {
        const double expected = parts_.wall_per_cpu() * studies::expected_seconds(step, taken);
        if (expected > time_left() || time_left() <= 0.0) {
          result_.not_run.push_back(
              {step.name(), fmt::format("would take about {}, and the time limit leaves {}",
                                        duration(expected), duration(std::max(0.0, time_left())))});
          continue;
        }
        const std::string unfit = parts_.does_not_fit(step);
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
        if (!parts_.has(ladder[j], task_.view.seed)) {
          left += parts_.wall_per_cpu() * studies::expected_seconds(ladder[j], taken);
        }
      }
      parts_.tell(fmt::format("{} of {}: {}", k + 1, ladder.size(), step.name()), left,
                  fmt::format("{:.2g} % in {}", 100.0 * result_.points.back().error.error,
                              duration(cost.wall_seconds)));
    }
  }

  const AccuracyTask& task_;
  studies::StudyScene scene_;
  AccuracyParts parts_;
  AccuracyResult result_;
  std::vector<bool> counted_;
  ReferencePair full_, gathered_, straight_;
  bool differs_ = false;
  std::vector<studies::AccuracyStep> ladder_;
};

}  // namespace

AccuracyResult measure_accuracy(const AccuracyTask& task) { return Study(task).run(); }

}  // namespace earthshine::app
