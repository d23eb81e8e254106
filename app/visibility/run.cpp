// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/output.h"
#include "app/report/page.h"
#include "app/study/results.h"
#include "app/study/study.h"
#include "app/visibility/answers.h"
#include "app/visibility/camera_work.h"
#include "app/visibility/conditions.h"
#include "app/visibility/pictures.h"
#include "app/visibility/plan.h"
#include "app/visibility/results.h"
#include "app/visibility/thumbnails.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

namespace fs = std::filesystem;

StudyParts prepare_all(const studies::StudyFile& study, const Common& common) {
  StudyParts parts;
  for (std::size_t k = 0; k < study.scenes.size(); ++k) {
    for (auto& part : prepare_parts(study, k, common)) parts.push_back(std::move(part));
  }
  return parts;
}

std::vector<const StudyPart*> pointers(const StudyParts& parts) {
  std::vector<const StudyPart*> all;
  for (const auto& part : parts) all.push_back(part.get());
  return all;
}

// Whether the folder has the results of a complete run.
bool has_finished_results(const fs::path& folder) {
  const Json study = json_in(folder / study_file);
  return study.is_object() && study.contains("complete") && study["complete"] == true;
}

// Rejects a CCTV setting for a camera that no scene has, which would have no effect.
void check_models(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts) {
  std::vector<std::string> names;
  for (const StudyPart* part : parts) {
    for (const scenes::Camera& camera : part->loaded.scene.cameras) names.push_back(camera.name);
  }
  for (const auto& [name, model] : study.camera_models) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw base::Error(base::Blame::Input, study.place("camera_models"),
                      "camera_models: no scene has a camera " + scenes::in_quotes(name),
                      "there are " + scenes::listed(names), scenes::did_you_mean(name, names));
  }
}

class Runner {
 public:
  Runner(const StudyTask& task, const Common& common, const StudyParts& parts)
      : task_(task),
        common_(common),
        parts_(pointers(parts)),
        limits_(parts.size()),
        results_(begin_results(task.study, parts_, task.command, common.seed)) {}

  [[nodiscard]] StudyResults run() {
    const Interrupt interrupt;
    configurations_.resize(task_.study.wanted.size());
    for (const StudyPart* part : parts_) expect_work(*part);
    std::optional<StudyFrames::Poses> poses;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const StudyPart* const part = parts_[k];
      const bool more = k + 1 < parts_.size() && parts_[k + 1]->first_pose != nullptr;
      if (part->first_pose == nullptr) poses.reset();
      if (!poses && more) poses.emplace();
      StudyFrames frames(*part, fs::path(task_.folder) / points_folder, common_, task_.part,
                         poses ? &*poses : nullptr);
      StudyConditions conditions(*part, task_.study, frames.store(), common_);
      for (const StudyCamera& camera : part->cameras) {
        if (!judge_camera(*part, camera, frames, conditions)) results_.complete = false;
      }
    }
    // A stopped study has no answers.
    for (std::size_t k = 0; results_.complete && k < configurations_.size(); ++k) {
      results_.answers.push_back(answer_of(task_.study.wanted[k], task_.study, configurations_[k]));
    }
    expose_figures(task_.folder, task_.tone, results_.figures);
    results_.pairs = pairs_of(task_.study, results_.figures);
    results_.notes = notes_of(results_, parts_, limits_);
    return std::move(results_);
  }

 private:
  void expect_work(const StudyPart& part) {
    const LoadedScene& basis = part.basis_scene;
    if (part.cameras.empty()) return;
    common_.progress->expect(Work::StudySolve, static_cast<double>(basis.scene.triangles.size()));
    for (const StudyCamera& camera : part.cameras) {
      common_.progress->expect(Work::StudyPicture, part.picture_units(camera));
      common_.progress->expect(Work::Conditions, units_of_conditions(part, camera));
    }
  }

  // Whether all was done.
  bool judge_camera(const StudyPart& part, const StudyCamera& camera, StudyFrames& frames,
                    StudyConditions& conditions) {
    CameraFindings found{part, camera, 0.0, 0.0, Judged(part.conditions())};
    const Json frame_cache_key = frames.cache_key(camera);
    const PictureTask pictures{task_.study,  parts_,          part,           camera,
                               task_.folder, frame_cache_key, frames.store(), common_};
    const CameraWork work(pictures, frames, conditions);
    if (!take_finished(work, found)) {
      std::optional<StudyFrames::Frame> frame;
      if (!Interrupt::asked()) frame = frames.frame(camera, results_.costs);
      if (frame) judge_frame(work, *frame, found);
    }
    add_camera(results_, found);
    const Judged& done = found.conditions;
    return !Interrupt::asked() &&
           std::all_of(done.begin(), done.end(), [](const auto& one) { return one.has_value(); });
  }

  void take(const StudyFrames::Frame& frame, CameraFindings& found) {
    found.relative_noise = frame.relative_noise;
    found.render_seconds = frame.seconds;
    const auto part = std::find(parts_.begin(), parts_.end(), &found.part);
    results_.scenes[found.part.scene].patches = frame.patches;
    limits_[static_cast<std::size_t>(part - parts_.begin())] = frame.limits;
  }

  void add_all(const std::vector<std::vector<ViewingConfiguration>>& more) {
    for (std::size_t k = 0; k < more.size(); ++k) {
      for (const ViewingConfiguration& configuration : more[k])
        add_configuration(configurations_[k], configuration);
    }
  }

  // Uses stored results if an earlier run completed the camera, without reading the picture.
  bool take_finished(const CameraWork& work, CameraFindings& found) {
    if (!pictures_are_there(work.pictures())) return false;
    const auto configurations = work.known_configurations();
    auto judged = work.known_conditions();
    if (!configurations || !judged || !thumbnails_are_there(work, *judged)) return false;
    const auto frame = work.known_frame(results_.costs);
    if (!frame) return false;
    common_.progress->drop(Work::StudyPicture);
    common_.progress->drop(Work::Conditions);
    take(*frame, found);
    found.conditions = std::move(*judged);
    results_.costs.push_back(
        {fmt::format("conditions {} {}", found.part.id, found.camera.camera->name), 0.0, 0, true});
    add_all(*configurations);
    draw_pictures(work.pictures(), nullptr, results_.figures);
    found.thumbnails = draw_thumbnails(work, nullptr, found.conditions);
    return true;
  }

  void judge_frame(const CameraWork& work, StudyFrames::Frame& frame, CameraFindings& found) {
    take(frame, found);
    const studies::BasisView view = work.view_of(frame, results_.costs);
    found.conditions = work.judge(view, frame, work.all_batches(), results_.costs);
    if (Interrupt::asked()) return;
    add_all(work.conclude(view, results_.figures));
    if (Interrupt::asked()) return;
    found.thumbnails = draw_thumbnails(work, &view, found.conditions);
  }

  const StudyTask& task_;
  const Common& common_;
  const std::vector<const StudyPart*> parts_;
  std::vector<std::vector<std::string>> limits_;  // of each part's solution
  StudyResults results_;
  std::vector<std::vector<ViewingConfiguration>> configurations_;
};

void note_unused(const StudyTask& task) {
  const studies::StudyFile& study = task.study;
  for (const std::string& warning : study.warnings) note("warning: " + warning);
  if (!study.iris.empty() && study.wanted.empty()) {
    const std::string_view dashes = study.path.empty() ? "--" : "";
    note(fmt::format(
        "note: {0}iris has no effect: it is what {0}wanted may choose, which is not there",
        dashes));
  }
  const bool placed = std::ranges::any_of(study.overrides, [](const std::string& setting) {
    return setting.starts_with("orbit.position_deg=");
  });
  if (placed && !study.positions_deg.empty()) {
    note("note: orbit.position_deg has no effect: the study sets the positions");
  }
}

// Pictures by cameras that are skipped wherever the picture's place is are skipped too.
void drop_pictures_of_skipped(studies::StudyFile& study, const std::vector<const StudyPart*>& parts,
                              bool quiet) {
  std::erase_if(study.pictures, [&](const studies::PictureWish& wish) {
    const auto is_wanted = [&](const auto& camera) { return camera.name == wish.camera; };
    std::string skipped_at;
    bool skipped = false;
    for (const StudyPart* part : parts) {
      if (!has_place(*part, wish)) continue;
      if (std::ranges::any_of(part->cameras,
                              [&](const StudyCamera& c) { return is_wanted(*c.camera); })) {
        return false;
      }
      if (!std::ranges::any_of(part->skipped,
                               [&](const scenes::Camera* c) { return is_wanted(*c); })) {
        continue;
      }
      skipped = true;
      skipped_at = part->skipped_at;
    }
    if (skipped && !quiet && !skipped_at.empty()) {
      note(fmt::format("skipped: [[picture]] {}: camera {} is inside a body at {}",
                       scenes::in_quotes(wish.name), scenes::in_quotes(wish.camera), skipped_at));
    }
    return skipped;
  });
}

// The scenes of the task, and its name and pictures where it says nothing of them.
StudyParts prepare(StudyTask& task, const Common& common) {
  if (!common.quiet) note_unused(task);
  StudyParts parts = prepare_all(task.study, common);
  check_models(task.study, pointers(parts));
  if (!parts.front()->moments.empty()) {
    task.study.timeline = false;  // no circle that closes
    task.study.positions_deg.clear();
    for (const auto& part : parts) {
      if (part->scene > 0) break;
      task.study.positions_deg.insert(task.study.positions_deg.end(), part->positions_deg.begin(),
                                      part->positions_deg.end());
    }
  }
  const std::string& scene = parts.front()->loaded.scene.name;
  if (task.study.path.empty() && !scene.empty()) task.study.name = scene;
  drop_pictures_of_skipped(task.study, pointers(parts), common.quiet);
  const auto seeing =
      std::ranges::find_if(parts, [](const auto& part) { return !part->cameras.empty(); });
  fill_pictures(task.study, **seeing);
  check_pictures(task.study, pointers(parts));
  return parts;
}

}  // namespace

Json plan_study(StudyTask task, const Common& common) {
  const StudyParts parts = prepare(task, common);
  return plan_json(task.study, pointers(parts), task.folder, common);
}

std::optional<StudyResults> run_study(StudyTask task, const Common& common) {
  const StudyParts parts = prepare(task, common);
  std::vector<std::string> skipped;
  for (const auto& part : parts) {
    for (const scenes::Camera* camera : part->skipped) {
      const std::string at = part->skipped_at.empty() ? "" : " at " + part->skipped_at;
      skipped.push_back(camera->name + (task.study.scenes.size() > 1 ? " of " + part->path : "") +
                        at);
      // Notes are those of a scene's first pose.
      const auto first = std::ranges::find_if(
          parts, [&](const auto& other) { return other->scene == part->scene; });
      (*first)->loaded.scene.warnings.push_back(fmt::format(
          "camera {} is inside a body{} and was skipped", scenes::in_quotes(camera->name), at));
    }
  }
  const std::vector<std::string> files = {study_file, results_table, report_file};
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
  StudyResults study = Runner(task, common, parts).run();
  study.skipped = std::move(skipped);
  if (!study.complete && has_finished_results(task.folder)) {
    throw base::Error(base::Blame::Work, "study", "interrupted", {},
                      "The results of the previous run are in " + task.folder +
                          "; run the same command again to go on");
  }
  const Json json = to_json(study);
  base::write_text(fs::path(task.folder) / study_file, dump_lines(json));
  base::write_text(fs::path(task.folder) / results_table, results_csv(study));
  ReportOptions how;
  how.quiet = common.quiet;
  // Identical to a later `report`.
  write_report(task.folder, read_results(study_file, json), how);
  if (!study.complete) {
    throw base::Error(
        base::Blame::Work, "study", "interrupted", {},
        "Run the same command again: it goes on with what is finished in " + task.folder);
  }
  return study;
}

void run_and_print(StudyTask task, const Common& common, bool json, bool dry_run,
                   std::string (*text)(const StudyResults& study)) {
  if (dry_run) {
    const Json plan = plan_study(std::move(task), common);
    return print(json ? dump(plan) : plan_text(plan));
  }
  note_unused_json(task.part, json, common.quiet);
  const std::optional<StudyResults> found = run_study(std::move(task), common);
  if (!found) return;  // a part has no output
  print(json ? dump_lines(to_json(*found)) : text(*found));
  check_skipped(found->skipped);
}

}  // namespace earthshine::app
