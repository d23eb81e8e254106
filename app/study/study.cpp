// SPDX-License-Identifier: Apache-2.0
// earthshine study: studies of a scene, each with a folder of output files.
#include "app/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/call/render_call.h"
#include "app/console.h"
#include "app/options.h"
#include "base/error.h"

namespace earthshine::app {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

void add_study_options(CLI::App& command, StudyCall& call) {
  add_scene_options(command, call.scene);
  command.add_option("-o,--output", call.folder, "Folder for the results; made if it is not there")
      ->type_name("DIR")
      ->required();
  add_size_option(command, call.size);
  command.add_flag("--json", call.json, "Results as JSON on standard output");
}

void add_cameras_option(CLI::App& command, StudyCall& call) {
  may_repeat(command.add_option("--camera", call.cameras,
                                "Cameras: A or A,B (may be repeated; default: all)"))
      ->type_name("NAME");
}

void add_camera_option(CLI::App& command, StudyCall& call) {
  command.add_option("--camera", call.cameras, "Camera of the scene (default: its first)")
      ->type_name("NAME")
      ->expected(1)
      ->allow_extra_args(false);
}

const scenes::Camera& camera_of(const StudyCall& call, const scenes::Scene& scene, bool quiet) {
  const std::vector<const scenes::Camera*> named = wanted_cameras(call.cameras, scene);
  if (named.size() > 1) {
    throw Error(Blame::Input, "--camera",
                "\"" + call.cameras.front() + "\" is more than one camera",
                "this study looks through one", "Run it once for each");
  }
  const scenes::Camera& camera = *named.front();
  if (call.cameras.empty() && scene.cameras.size() > 1 && !quiet) {
    note("note: no --camera, taking the first, \"" + camera.name + "\"");
  }
  return camera;
}

void add_wanted_options(CLI::App& command, std::vector<std::string>& wanted,
                        std::vector<std::string>& iris) {
  may_repeat(command.add_option("--wanted", wanted,
                                "TARGET>=P: what it takes to detect the target with that "
                                "probability (may be repeated)"))
      ->type_name("TARGET>=P");
  command
      .add_option("--iris", iris, "Iris modes that --wanted may choose: fixed,peak,normal,average")
      ->type_name("LIST")
      ->delimiter(',')
      ->check(CLI::IsMember({"fixed", "peak", "normal", "average"}));
}

studies::StudyFile study_of(const StudyCall& call, const std::vector<std::string>& wanted,
                            const std::vector<std::string>& iris) {
  studies::StudyFile study;
  study.scenes = {call.scene.path};
  study.name = std::filesystem::path(call.scene.path).stem().string();
  study.overrides = call.scene.overrides;
  study.cameras = call.cameras;
  if (call.size) {
    study.columns = call.size->columns;
    study.rows = call.size->rows;
  }
  study.lamps = {studies::lamps_as_they_are()};
  study.iris = iris;
  std::sort(study.iris.begin(), study.iris.end());
  study.iris.erase(std::unique(study.iris.begin(), study.iris.end()), study.iris.end());
  for (const std::string& text : wanted) {
    study.wanted.push_back(studies::read_wanted(text, base::Location{"--wanted"}));
  }
  return study;
}

std::vector<Command> add_study(CLI::App& program) {
  CLI::App* study =
      add_subcommand(program, "study",
                     "Questions answered about a scene: visibility, orbit, compare, accuracy, run");
  study->require_subcommand(1);
  return {{study, {}},
          add_study_visibility(*study),
          add_study_compare(*study),
          add_study_accuracy(*study),
          add_study_orbit(*study),
          add_study_run(*study)};
}

}  // namespace earthshine::app
