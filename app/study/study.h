// SPDX-License-Identifier: Apache-2.0
// Common code of the studies: scene and folder, tables, file names.
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
  std::vector<std::string> cameras;  // empty: chosen by the study
  std::optional<Size> size;
  bool json = false;
  PartCall part;
};
// -o, --size, --json and what add_scene_options adds.
void add_study_options(CLI::App& command, StudyCall& call);
// --camera, repeatable.
void add_cameras_option(CLI::App& command, StudyCall& call);
// --camera for a study with one camera.
void add_camera_option(CLI::App& command, StudyCall& call);
// This camera; notes the choice if the call names none and there are several, unless `quiet`.
[[nodiscard]] const scenes::Camera& camera_of(const StudyCall& call, const scenes::Scene& scene,
                                              bool quiet);
// --wanted and --iris.
void add_wanted_options(CLI::App& command, std::vector<std::string>& wanted,
                        std::vector<std::string>& iris);
// The call as a study of one scene, at its own position with its own lamp settings.
[[nodiscard]] studies::StudyFile study_of(const StudyCall& call,
                                          const std::vector<std::string>& wanted,
                                          const std::vector<std::string>& iris);

[[nodiscard]] Command add_study_accuracy(CLI::App& study);
[[nodiscard]] Command add_study_compare(CLI::App& study);
[[nodiscard]] Command add_study_orbit(CLI::App& study);
[[nodiscard]] Command add_study_run(CLI::App& study);
[[nodiscard]] Command add_study_visibility(CLI::App& study);

}  // namespace earthshine::app
