// SPDX-License-Identifier: Apache-2.0
#include "app/study_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/report_page.h"
#include "app/study.h"
#include "app/study_answers.h"
#include "app/study_conditions.h"
#include "app/study_pictures.h"
#include "app/study_plan.h"
#include "app/study_results.h"
#include "base/error.h"
#include "base/output_file.h"
#include "scenes/message_text.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* points_folder = "points";

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

// A CCTV camera for a camera that no scene has would go unnoticed.
void check_models(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts) {
  std::vector<std::string> names;
  for (const StudyPart* part : parts) {
    for (const scenes::Camera& camera : part->loaded.scene.cameras) names.push_back(camera.name);
  }
  for (const auto& [name, model] : study.camera_models) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw base::Error(base::Blame::Input, "camera_models",
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
      StudyFrames frames(*part, fs::path(task_.folder) / points_folder, common_);
      StudyConditions conditions(*part, task_.study, fs::path(task_.folder) / points_folder,
                                 common_);
      for (const StudyCamera& camera : part->cameras) {
        if (!look_through(*part, camera, frames, conditions)) findings_.complete = false;
      }
    }
    for (std::size_t k = 0; k < ways_.size(); ++k) {
      findings_.answers.push_back(answer_json(task_.study.wanted[k], task_.study, ways_[k]));
    }
    findings_.pairs = pairs_json(task_.study, findings_.figures);
  }

  [[nodiscard]] const StudyFindings& findings() const { return findings_; }

 private:
  // Whether all was done.
  bool look_through(const StudyPart& part, const StudyCamera& camera, StudyFrames& frames,
                    StudyConditions& conditions) {
    CameraResults found{&part, &camera, 0.0, 0.0, std::vector<Json>(part.conditions())};
    std::optional<StudyFrames::Frame> frame;
    if (!Interrupt::asked()) frame = frames.frame(camera, findings_.costs);
    if (frame) {
      found.relative_noise = frame->relative_noise;
      found.render_seconds = frame->seconds;
      findings_.patches[part.id] = frame->patches;
      const studies::BasisView view = studies::make_basis_view(
          *part.basis, *part.query, *camera.camera, std::move(frame->image));
      found.conditions = conditions.judge(camera, view, frames.marks(camera), findings_.costs);
      if (!Interrupt::asked()) {
        draw_pictures(task_.study, part, camera, view, task_.folder, common_, findings_.figures);
        add_ways(part, task_.study, camera, view, ways_);
      }
      if (listen_) listen_(part, camera, view, *frame);
    }
    findings_.cameras.push_back(std::move(found));
    const auto& done = findings_.cameras.back().conditions;
    return !Interrupt::asked() &&
           std::none_of(done.begin(), done.end(), [](const Json& one) { return one.is_null(); });
  }

  const StudyTask& task_;
  const Common& common_;
  const ViewListener& listen_;
  StudyFindings findings_;
  std::vector<std::vector<WayOfLooking>> ways_;
};

}  // namespace

Json run_study(StudyTask task, const Common& common, const ViewListener& listen) {
  const Parts parts = prepare_parts(task.study, common);
  check_models(task.study, pointers(parts));
  fill_pictures(task.study, *parts.front());
  check_pictures(task.study, pointers(parts));
  if (task.dry_run) return plan_json(task.study, pointers(parts), task.folder, common);
  std::vector<std::string> files = {study_file, results_table, report_file};
  files.insert(files.end(), task.more_files.begin(), task.more_files.end());
  prepare_folder(task.folder, files);
  std::error_code ignored;
  fs::create_directories(fs::path(task.folder) / "pictures", ignored);
  for (const char* folder : {"", points_folder, "pictures"}) {
    base::remove_abandoned_files(fs::path(task.folder) / folder);
  }

  Runner runner(task, common, parts, listen);
  runner.run();
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
