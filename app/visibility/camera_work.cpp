// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/camera_work.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/study/json_fields.h"

namespace earthshine::app {

CameraWork::CameraWork(const PictureTask& pictures, StudyFrames& frames,
                       StudyConditions& conditions)
    : pictures_(pictures),
      frames_(frames),
      conditions_(conditions),
      answers_key_(conditions.cache_key(pictures.camera, pictures.frame_cache_key, 0,
                                        pictures.part.conditions())) {
  answers_key_["what"] = "answers";
  for (const studies::WantedTarget& wanted : pictures.study.wanted) {
    answers_key_["wanted"].push_back(wanted.text);
  }
  answers_key_["iris"] = pictures.study.iris;
  answers_key_["path"] = pictures.part.path;
}

bool CameraWork::is_done(Share batches) const {
  for (std::size_t batch = batches.first; batch < batches.last; ++batch) {
    if (!conditions_.has(pictures_.camera, pictures_.frame_cache_key, batch)) return false;
  }
  return batches.first > 0 || (pictures_.store.has(answers_key_) && pictures_are_there(pictures_) &&
                               frames_.has(pictures_.camera));
}

std::optional<CameraWork::Configurations> CameraWork::known_configurations() const {
  std::string said;
  const auto kept = pictures_.store.find_facts(answers_key_, said);
  return kept ? std::optional(read_kept<Configurations>((*kept)["configurations"])) : std::nullopt;
}

std::optional<Judged> CameraWork::known_conditions() const {
  return conditions_.find(pictures_.camera, pictures_.frame_cache_key);
}

std::optional<StudyFrames::Frame> CameraWork::known_frame(std::vector<StudyCost>& costs) const {
  return frames_.known(pictures_.camera, costs);
}

studies::BasisView CameraWork::view_of(StudyFrames::Frame& frame,
                                       std::vector<StudyCost>& costs) const {
  return studies::make_basis_view(*pictures_.part.basis, *pictures_.part.query,
                                  *pictures_.camera.camera, std::move(frame.image),
                                  &frames_.solution(costs));
}

Judged CameraWork::judge(const studies::BasisView& view, const StudyFrames::Frame& frame,
                         Share batches, std::vector<StudyCost>& costs) const {
  return conditions_.judge(pictures_.camera, view, frame, pictures_.frame_cache_key, batches,
                           costs);
}

CameraWork::Configurations CameraWork::conclude(const studies::BasisView& view,
                                                std::vector<FigureEntry>& figures) const {
  try {
    draw_pictures(pictures_, &view, figures);
  } catch (const Interrupt::Left&) {
    return Configurations(pictures_.study.wanted.size());
  }
  if (auto kept = known_configurations()) return std::move(*kept);
  Configurations found(pictures_.study.wanted.size());
  add_configurations(pictures_.part, pictures_.study, pictures_.camera, view, found);
  pictures_.store.keep_facts(answers_key_, {{"configurations", kept_json(found)}});
  return found;
}

StudyShares::Scene::Scene(const StudyPart& scene, const StudyTask& task, const Common& common)
    : part(scene),
      frames(scene, std::filesystem::path(task.folder) / points_folder, common, task.part),
      conditions(scene, task.study, frames.store(), common) {}

StudyShares::StudyShares(StudyTask& task, const Common& common, std::vector<const StudyPart*> parts)
    : task_(task), common_(common), parts_(std::move(parts)) {
  for (const StudyPart* part : parts_) {
    scenes_.emplace_back(*part, task, common);
    all_batches_ += part->cameras.size() * scenes_.back().conditions.batches();
  }
}

bool StudyShares::run() {
  using Task = PartCall::Task;
  join_parts(points(), common_, digests(), task_.part);
  if (task_.part.task == Task::Merge) {
    check_complete();
    return true;
  }
  const Interrupt interrupt;
  if (task_.part.task == Task::Solve) {
    solve();
  } else {
    do_share();
  }
  return false;
}

std::filesystem::path StudyShares::points() const {
  return std::filesystem::path(task_.folder) / points_folder;
}

void StudyShares::for_each_camera(const Visit& visit) {
  std::size_t first = 0;
  for (Scene& scene : scenes_) {
    for (const StudyCamera& camera : scene.part.cameras) {
      const Json key = scene.frames.cache_key(camera);
      const PictureTask pictures{task_.study,  parts_, scene.part,           camera,
                                 task_.folder, key,    scene.frames.store(), common_};
      visit(CameraWork(pictures, scene.frames, scene.conditions), scene.frames, first);
      first += scene.conditions.batches();
    }
    scene.frames.forget_solution();
  }
}

Json StudyShares::digests() {
  Json scenes = Json::array(), settings = Json::array();
  for_each_camera([&](const CameraWork& work, StudyFrames& frames, std::size_t) {
    scenes.push_back(frames.scene_key());
    settings.push_back(work.settings());
  });
  return {{"scene", digest_of(scenes)}, {"settings", digest_of(settings)}};
}

void StudyShares::do_share() {
  const Share mine = share_of(task_.part, all_batches_);
  for_each_camera([&](const CameraWork& work, StudyFrames& frames, std::size_t first) {
    const std::size_t from = std::max(mine.first, first);
    const std::size_t to = std::min(mine.last, first + work.all_batches().last);
    if (from >= to || Interrupt::asked()) return;
    const Share batches{from - first, to - first};
    if (work.is_done(batches)) return;
    std::optional<StudyFrames::Frame> frame = frames.frame(work.pictures().camera, costs_);
    if (!frame) return;  // interrupted
    const studies::BasisView view = work.view_of(*frame, costs_);
    (void)work.judge(view, *frame, batches, costs_);
    std::vector<FigureEntry> figures;
    if (batches.first == 0 && !Interrupt::asked()) (void)work.conclude(view, figures);
  });
  end_part_if_interrupted();
  if (common_.quiet) return;
  const std::string done =
      mine.first == mine.last
          ? fmt::format("nothing to do: the study has {} batches", all_batches_)
          : fmt::format("batches {} to {} are in {}", mine.first + 1, mine.last, points().string());
  note(fmt::format("part {} of {}: {}", task_.part.number, task_.part.count, done));
}

void StudyShares::solve() {
  for (Scene& scene : scenes_) {
    end_part_if_interrupted();
    (void)scene.frames.solution(costs_);
    scene.frames.forget_solution();
  }
}

void StudyShares::check_complete() {
  const std::size_t parts = std::max<std::size_t>(1, task_.part.count);
  std::vector<MissingWork> missing;
  for_each_camera([&](const CameraWork& work, StudyFrames&, std::size_t first) {
    const std::size_t count = work.all_batches().last;
    const PictureTask& pictures = work.pictures();
    for (std::size_t batch = 0; batch < count; ++batch) {
      if (work.is_done({batch, batch + 1})) continue;
      missing.push_back(
          {fmt::format("camera {} of {}, batch {} of {}", pictures.camera.camera->name,
                       pictures.part.path, batch + 1, count),
           part_of(first + batch, all_batches_, parts)});
    }
  });
  if (!missing.empty()) refuse_to_merge(task_.folder, missing);
}

}  // namespace earthshine::app
