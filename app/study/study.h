// SPDX-License-Identifier: Apache-2.0
// What the studies share: scene and folder, tables, the name of a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/parts/part.h"
#include "raytrace/render.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// Options of every study.
struct StudyCall {
  SceneInput scene;
  std::string folder;
  std::vector<std::string> cameras;  // empty: the study's own choice
  std::optional<Size> size;
  bool json = false;
  PartCall part;
};
// -o, --size, --json and what add_scene_options adds.
void add_study_options(CLI::App& command, StudyCall& call);
// --camera, which may be repeated.
void add_cameras_option(CLI::App& command, StudyCall& call);
// --camera of a study of one.
void add_camera_option(CLI::App& command, StudyCall& call);
// That one; a note says which where the call does not and there are several, unless `quiet`.
[[nodiscard]] const scenes::Camera& camera_of(const StudyCall& call, const scenes::Scene& scene,
                                              bool quiet);
// --wanted and --iris.
void add_wanted_options(CLI::App& command, std::vector<std::string>& wanted,
                        std::vector<std::string>& iris);
// The call as a study of one scene at its own place, with its lamps as they are.
[[nodiscard]] studies::StudyFile study_of(const StudyCall& call,
                                          const std::vector<std::string>& wanted,
                                          const std::vector<std::string>& iris);

[[nodiscard]] Command add_study_accuracy(CLI::App& study);
[[nodiscard]] Command add_study_compare(CLI::App& study);
[[nodiscard]] Command add_study_orbit(CLI::App& study);
[[nodiscard]] Command add_study_run(CLI::App& study);
[[nodiscard]] Command add_study_visibility(CLI::App& study);

}  // namespace earthshine::app
