// SPDX-License-Identifier: Apache-2.0
// What the studies share: scene and folder, tables, the name of a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "studies/study.h"
#include "studies/study_file.h"

namespace earthshine::app {

// Options of every study.
struct StudyCall {
  SceneInput scene;
  std::string folder;
  std::vector<std::string> cameras;  // empty: the study's own choice
  std::optional<Size> size;
  bool json = false;
};
// -o, --size, --json and what add_scene_options adds.
void add_study_options(CLI::App& command, StudyCall& call);
// --camera, which may be repeated.
void add_cameras_option(CLI::App& command, StudyCall& call);
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

// Makes the folder where there is none and sees that each of the files can be written in it.
// Throws base::Error before any work is done.
void prepare_folder(const std::string& folder, const std::vector<std::string>& files);

// A progress line per stage of a study.
[[nodiscard]] studies::StageListener progress_of_stages(const Common& common);

// A camera's name as the start of a file name: letters, digits, '.', '-' and '_' stay, others
// become '_'. Where two cameras would meet, the later ones get their number in the scene.
[[nodiscard]] std::string file_stem(const scenes::Scene& scene, const scenes::Camera& camera);

// Comma-separated values (RFC 4180): `rows` are flat objects with the keys of the first, which
// become the header. null is an empty field.
[[nodiscard]] std::string csv_of(const Json& rows);

// A number, or null.
template <class Number>
[[nodiscard]] Json to_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace earthshine::app
