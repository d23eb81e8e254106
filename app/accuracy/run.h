// SPDX-License-Identifier: Apache-2.0
// Runs `study accuracy`: references and ladder in parts, each stored when it is finished.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/parts/result_cache.h"
#include "app/study/study.h"
#include "studies/accuracy/accuracy.h"
#include "studies/accuracy/findings.h"

namespace earthshine::app {

struct AccuracyCall : StudyCall {
  std::vector<double> wanted = {0.05, 0.02, 0.01};
  double reference_factor = 2.0;  // ratio of the smallest wanted error to the reference's error
  double time_limit_s = 0.0;      // 0: none
  studies::LadderOptions ladder;  // its errors follow from `wanted` and the scene
};

// Smallest error that a method can reach.
struct MethodLimit {
  std::string method;
  studies::PictureError error;
  std::string why;
};

struct NotRun {
  std::string name, why;
};

struct AccuracyResult {
  std::string nothing;  // reason why there is nothing to measure; "": there is something
  std::size_t pixels = 0;
  double mean_luminance = 0.0;  // without direct light, cd/m^2
  double resolution = 0.0;      // of the reference, relative
  double wanted_resolution = 0.0;
  int reference_paths = 0;             // per pixel, of each of the two pictures
  double reference_cpu_seconds = 0.0;  // of all references
  std::vector<MethodLimit> limits;
  std::vector<studies::MeasuredStep> points;  // in the ladder's order
  std::vector<NotRun> not_run;
  studies::Findings findings;
};

struct AccuracyTask {
  const AccuracyCall& call;
  const Common& common;
  const LoadedScene& loaded;
  const scenes::RayQuery& query;
  studies::AccuracyView view;
  const ResultCache& store;
};

// Throws base::Error (Work) with the finished results when view.stop returns true.
[[nodiscard]] AccuracyResult measure_accuracy(const AccuracyTask& task);

// Work of a part: rounds of references, and steps grouped by solution. Steps are assigned
// round-robin, because their cost rises along the ladder. Every part computes or reads the first
// round, which determines the number of rounds.
void share_accuracy(const AccuracyTask& task, PartCall& part);

}  // namespace earthshine::app
