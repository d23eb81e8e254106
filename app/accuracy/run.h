// SPDX-License-Identifier: Apache-2.0
// `study accuracy` at work: the references and the ladder, part by part, each kept as it is
// finished.
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
  double reference_factor = 2.0;  // how much finer the reference than the least wanted error
  double time_limit_s = 0.0;      // 0: none
  studies::LadderOptions ladder;  // its errors follow from `wanted` and the scene
};

// What a method can come to at best.
struct MethodLimit {
  std::string method;
  studies::PictureError error;
  std::string why;
};

struct NotRun {
  std::string name, why;
};

struct AccuracyResult {
  std::string nothing;  // why there is nothing to measure; "": there is
  std::size_t pixels = 0;
  double mean_luminance = 0.0;  // without light straight from the sources, cd/m^2
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

// Throws base::Error (Work) with what is finished once view.stop says so.
[[nodiscard]] AccuracyResult measure_accuracy(const AccuracyTask& task);

// The work of a part: rounds of references, and steps by the solution that they read, dealt out in
// turn, as they become dearer along the ladder. The first round, which says how many follow, is
// found or done by every part.
void share_accuracy(const AccuracyTask& task, PartCall& part);

}  // namespace earthshine::app
