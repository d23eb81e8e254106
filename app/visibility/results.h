// SPDX-License-Identifier: Apache-2.0
// study.json and visibility tables of a visibility study, from what its cameras found.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/views/frames.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// One camera's part of the results.
struct CameraResults {
  const StudyPart* part = nullptr;
  const StudyCamera* camera = nullptr;
  double relative_noise = 0.0, render_seconds = 0.0;
  std::vector<Json> conditions;  // a list of targets for each condition; null: not reached
};

struct StudyFindings {
  explicit StudyFindings(const studies::StudyFile& of) : study(of) {}

  const studies::StudyFile& study;
  std::string command;  // as it was called
  std::uint64_t seed = 1;
  std::vector<const StudyPart*> parts;
  std::vector<CameraResults> cameras;
  Json answers = Json::array(), pairs = Json::array(), figures = Json::array(),
       thumbnails = Json::array();
  std::vector<StudyCost> costs;
  Json limits = Json::object();  // reached by each scene's solution, lists of texts by its id
  std::map<std::string, std::size_t> patches;  // of each scene, by its id
  bool complete = true;
};

// The whole of study.json.
[[nodiscard]] Json study_json(const StudyFindings& findings);

// visibility.csv: a row per condition, camera and target.
[[nodiscard]] std::string study_csv(const Json& study);

// For people: a line per camera, target and lamp setting, the answers, and black backs.
[[nodiscard]] std::string study_text(const Json& study);

}  // namespace earthshine::app
