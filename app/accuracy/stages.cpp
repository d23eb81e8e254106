// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy/stages.h"

#include <algorithm>

#include "raytrace/camera/camera.h"

namespace earthshine::app {

using studies::Batch;
using studies::ReferencePair;

namespace {

constexpr int most_paths = 1 << 14;  // per pixel and side

}  // namespace

ReferencePair PathReference::pair() const {
  return {studies::mean_of_batches(batches[0], pictures[0]),
          studies::mean_of_batches(batches[1], pictures[1])};
}

AccuracyStages::AccuracyStages(const AccuracyTask& task)
    : task_(task),
      scene_{task.loaded.scene, task.loaded.groups, task.loaded.effects, task.query},
      parts_(task, scene_) {}

void AccuracyStages::trace_round(std::vector<PathReference>& references, int index, int paths) {
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

double AccuracyStages::finest() const {
  return *std::min_element(task_.call.wanted.begin(), task_.call.wanted.end());
}

std::vector<PathReference> AccuracyStages::new_references() const {
  std::vector<PathReference> references(1);
  if (studies::leaves_paths_out(task_.loaded.effects)) {
    references.push_back({raytrace::PathSet::NoCaustics, {}, {}});
  }
  return references;
}

std::string AccuracyStages::nothing_to_measure() {
  if (task_.loaded.groups.count() == 0 &&
      base::max_component(task_.loaded.scene.ambient_radiance) <= 0.0) {
    return "nothing gives light: the picture is black, and has no error";
  }
  const raytrace::CameraModel camera =
      raytrace::make_camera_model(task_.view.camera, task_.view.columns, task_.view.rows);
  counted_ = studies::surface_pixels(scene_, camera);
  result_.pixels = std::size_t(std::count(counted_.begin(), counted_.end(), true));
  if (result_.pixels > 0) return "";
  return "no pixel shows a surface that is no source: there is nothing to compare";
}

bool AccuracyStages::trace_first(std::vector<PathReference>& references) {
  trace_round(references, 0, first_paths);
  full_ = references.front().pair();
  return studies::mean_luminance(full_, counted_) > 0.0;
}

std::vector<int> AccuracyStages::further_rounds() {
  result_.wanted_resolution = finest() / task_.call.reference_factor;
  return studies::further_batches(first_paths, studies::resolution(full_, counted_),
                                  result_.wanted_resolution, most_paths);
}

studies::AccuracyStep AccuracyStages::straight_step() const {
  return studies::straight_step(task_.loaded.scene, finest());
}
std::uint64_t AccuracyStages::straight_seed(int side) const {
  return studies::reference_seed(task_.view.seed, side, most_paths);
}

std::vector<studies::AccuracyStep> AccuracyStages::make_ladder() const {
  studies::LadderOptions options = task_.call.ladder;
  options.finest = finest();
  return studies::accuracy_ladder(task_.loaded.scene, task_.loaded.effects, options);
}

}  // namespace earthshine::app
