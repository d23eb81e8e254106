// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/report/page.h"
#include "app/study/study.h"
#include "app/visibility/answers.h"
#include "app/visibility/conditions.h"
#include "app/visibility/pictures.h"
#include "app/visibility/plan.h"
#include "app/visibility/results.h"
#include "app/visibility/shares.h"
#include "app/visibility/thumbnails.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

using Parts = std::vector<std::unique_ptr<StudyPart>>;

Parts prepare_parts(const studies::StudyFile& study, const Common& common) {
  Parts parts;
  for (std::size_t k = 0; k < study.scenes.size(); ++k) {
    parts.push_back(prepare_part(study, k, common));
  }
  return parts;
}

std::vector<const StudyPart*> pointers(const Parts& parts) {
  std::vector<const StudyPart*> all;
  for (const auto& part : parts) all.push_back(part.get());
  return all;
}

// Whether the folder holds the results of a run that came to its end.
bool has_finished_results(const fs::path& folder) {
  const Json study = json_in(folder / study_file);
  return study.is_object() && study.contains("complete") && study["complete"] == true;
}

// A CCTV camera for a camera that no scene has would go unnoticed.
void check_models(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts) {
  std::vector<std::string> names;
  for (const StudyPart* part : parts) {
    for (const scenes::Camera& camera : part->loaded.scene.cameras) names.push_back(camera.name);
  }
  for (const auto& [name, model] : study.camera_models) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw base::Error(base::Blame::Input, study.place("camera_models"),
                      "no scene has a camera " + scenes::in_quotes(name),
                      "there are " + scenes::listed(names), scenes::did_you_mean(name, names));
  }
}

class Runner {
 public:
  Runner(const StudyTask& task, const Common& common, const Parts& parts,
         const ViewListener& listen)
      : task_(task), common_(common), listen_(listen), findings_(task.study) {
    findings_.command = task.command;
    findings_.seed = common.seed;
    findings_.parts = pointers(parts);
  }

  void run() {
    const Interrupt interrupt;
    ways_.resize(task_.study.wanted.size());
    for (const StudyPart* part : findings_.parts) {
      StudyFrames frames(*part, fs::path(task_.folder) / points_folder, common_, task_.part);
      StudyConditions conditions(*part, task_.study, frames.store(), common_);
      for (const StudyCamera& camera : part->cameras) {
        if (!look_through(*part, camera, frames, conditions)) findings_.complete = false;
      }
    }
    // Of a study that was stopped there is nothing to conclude.
    for (std::size_t k = 0; findings_.complete && k < ways_.size(); ++k) {
      findings_.answers.push_back(answer_json(task_.study.wanted[k], task_.study, ways_[k]));
    }
    expose_figures(task_.folder, task_.tone, findings_.figures);
    findings_.pairs = pairs_json(task_.study, findings_.figures);
  }

  [[nodiscard]] const StudyFindings& findings() const { return findings_; }

 private:
  // Whether all was done.
  bool look_through(const StudyPart& part, const StudyCamera& camera, StudyFrames& frames,
                    StudyConditions& conditions) {
    CameraResults found{&part, &camera, 0.0, 0.0, std::vector<Json>(part.conditions())};
    const Json frame_cache_key = frames.cache_key(camera);
    const PictureTask pictures{task_.study,  findings_.parts, part,           camera,
                               task_.folder, frame_cache_key, frames.store(), common_};
    const CameraWork work(pictures, frames, conditions);
    if (!take_finished(work, found)) {
      std::optional<StudyFrames::Frame> frame;
      if (!Interrupt::asked()) frame = frames.frame(camera, findings_.costs);
      if (frame) look(work, *frame, found);
    }
    findings_.cameras.push_back(std::move(found));
    const auto& done = findings_.cameras.back().conditions;
    return !Interrupt::asked() &&
           std::none_of(done.begin(), done.end(), [](const Json& one) { return one.is_null(); });
  }

  void take(const StudyPart& part, const StudyFrames::Frame& frame, CameraResults& found) {
    found.relative_noise = frame.relative_noise;
    found.render_seconds = frame.seconds;
    findings_.patches[part.id] = frame.patches;
    findings_.limits[part.id] = frame.limits;
  }

  void add_all(const std::vector<std::vector<ViewingConfiguration>>& more) {
    for (std::size_t k = 0; k < more.size(); ++k) {
      ways_[k].insert(ways_[k].end(), more[k].begin(), more[k].end());
    }
  }

  // Where an earlier run has done all of it, so that not even the picture must be read.
  bool take_finished(const CameraWork& work, CameraResults& found) {
    if (listen_ || !pictures_are_there(work.pictures())) return false;
    const auto ways = work.known_configurations();
    const auto judged = work.known_conditions();
    if (!ways || !judged || !thumbnails_are_there(work, *judged)) return false;
    const auto frame = work.known_frame(findings_.costs);
    if (!frame) return false;
    const PictureTask& pictures = work.pictures();
    take(pictures.part, *frame, found);
    found.conditions = *judged;
    findings_.costs.push_back(
        {fmt::format("conditions {} {}", pictures.part.id, found.camera->camera->name), 0.0, 0,
         true});
    add_all(*ways);
    draw_pictures(pictures, nullptr, findings_.figures);
    draw_thumbnails(work, nullptr, *judged, findings_.thumbnails);
    return true;
  }

  void look(const CameraWork& work, StudyFrames::Frame& frame, CameraResults& found) {
    const PictureTask& pictures = work.pictures();
    take(pictures.part, frame, found);
    const studies::BasisView view = work.view_of(frame, findings_.costs);
    found.conditions = work.judge(view, work.all_batches(), findings_.costs);
    if (listen_) listen_(pictures.part, pictures.camera, view, frame);
    if (Interrupt::asked()) return;
    add_all(work.conclude(view, findings_.figures));
    draw_thumbnails(work, &view, found.conditions, findings_.thumbnails);
  }

  const StudyTask& task_;
  const Common& common_;
  const ViewListener& listen_;
  StudyFindings findings_;
  std::vector<std::vector<ViewingConfiguration>> ways_;
};

}  // namespace

std::optional<Json> run_study(StudyTask task, const Common& common, const ViewListener& listen) {
  const Parts parts = prepare_parts(task.study, common);
  check_models(task.study, pointers(parts));
  const std::string& scene = parts.front()->loaded.scene.name;
  if (task.study.path.empty() && !scene.empty()) task.study.name = scene;
  fill_pictures(task.study, *parts.front());
  check_pictures(task.study, pointers(parts));
  if (task.dry_run) return plan_json(task.study, pointers(parts), task.folder, common);
  std::vector<std::string> files = {study_file, results_table, report_file};
  files.insert(files.end(), task.more_files.begin(), task.more_files.end());
  Files inputs = {task.study.path};
  for (const auto& part : parts) {
    const Files& own = part->loaded.scene.files;
    inputs.insert(inputs.end(), own.begin(), own.end());
  }
  prepare_folder(task.folder, files, inputs);
  std::error_code ignored;
  fs::create_directories(fs::path(task.folder) / "pictures", ignored);
  for (const char* folder : {points_folder, "pictures"}) {
    refuse_inputs_in(fs::path(task.folder) / folder, inputs);
  }
  for (const char* folder : {"", points_folder, "pictures"}) {
    base::remove_abandoned_files(fs::path(task.folder) / folder);
  }

  if (task.part.in_parts() && !StudyShares(task, common, pointers(parts)).run()) {
    return std::nullopt;
  }
  Runner runner(task, common, parts, listen);
  runner.run();
  if (!runner.findings().complete && has_finished_results(task.folder)) {
    throw base::Error(base::Blame::Work, "study", "interrupted", {},
                      "The results of the run before stand in " + task.folder +
                          "; run the same command again to go on");
  }
  const Json study = study_json(runner.findings());
  base::write_text(fs::path(task.folder) / study_file, dump(study));
  base::write_text(fs::path(task.folder) / results_table, study_csv(study));
  ReportOptions how;
  how.quiet = common.quiet;
  write_report(task.folder, study, how);
  if (!runner.findings().complete) {
    throw base::Error(
        base::Blame::Work, "study", "interrupted", {},
        "Run the same command again: it goes on with what is finished in " + task.folder);
  }
  return study;
}

}  // namespace earthshine::app
