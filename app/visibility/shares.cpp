// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/shares.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/interrupt.h"
#include "base/error.h"
#include "base/numbers/digest.h"

namespace earthshine::app {
namespace {

std::string digest_of(const Json& json) {
  base::Digest digest;
  digest.add(std::string_view(dump(json)));
  return digest.text();
}

}  // namespace

StudyShares::StudyShares(StudyTask& task, const Common& common, std::vector<const StudyPart*> parts)
    : task_(task), common_(common), parts_(std::move(parts)) {}

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
  for (const StudyPart* part : parts_) {
    StudyFrames frames(*part, points(), common_, task_.part);
    StudyConditions conditions(*part, task_.study, points(), common_);
    for (const StudyCamera& camera : part->cameras) {
      const Json key = frames.cache_key(camera);
      const PictureTask pictures{task_.study, parts_, *part, camera, task_.folder, key, common_};
      visit(CameraWork(pictures, frames, conditions), frames, first);
      first += conditions.batches();
    }
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

std::size_t StudyShares::count_batches() {
  std::size_t all = 0;
  for_each_camera([&](const CameraWork& work, StudyFrames&, std::size_t first) {
    all = first + work.all_batches().last;
  });
  return all;
}

void StudyShares::do_share() {
  const Share mine = share_of(task_.part, count_batches());
  for_each_camera([&](const CameraWork& work, StudyFrames& frames, std::size_t first) {
    const std::size_t from = std::max(mine.first, first);
    const std::size_t to = std::min(mine.last, first + work.all_batches().last);
    if (from >= to || Interrupt::asked()) return;
    const Share batches{from - first, to - first};
    if (work.is_done(batches)) return;
    std::optional<StudyFrames::Frame> frame = frames.frame(work.pictures().camera, costs_);
    if (!frame) return;  // interrupted
    const studies::BasisView view = work.view_of(*frame, costs_);
    (void)work.judge(view, batches, costs_);
    Json figures = Json::array();
    if (batches.first == 0 && !Interrupt::asked()) (void)work.conclude(view, figures);
  });
  if (Interrupt::asked()) {
    throw base::Error(base::Blame::Work, "study", "interrupted", {},
                      "Run the same part again: it goes on with what is finished");
  }
  if (common_.quiet) return;
  note(fmt::format("part {} of {}: batches {} to {} are in {}", task_.part.number, task_.part.count,
                   mine.first + 1, mine.last, points().string()));
}

void StudyShares::solve() {
  for (const StudyPart* part : parts_) {
    (void)StudyFrames(*part, points(), common_, task_.part).solution(costs_);
  }
}

void StudyShares::check_complete() {
  const std::size_t all = count_batches(), parts = std::max<std::size_t>(1, task_.part.count);
  std::vector<MissingWork> missing;
  for_each_camera([&](const CameraWork& work, StudyFrames&, std::size_t first) {
    const std::size_t count = work.all_batches().last;
    const PictureTask& pictures = work.pictures();
    for (std::size_t batch = 0; batch < count; ++batch) {
      if (work.is_done({batch, batch + 1})) continue;
      missing.push_back(
          {fmt::format("camera {} of {}, batch {} of {}", pictures.camera.camera->name,
                       pictures.part.path, batch + 1, count),
           part_of(first + batch, all, parts)});
    }
  });
  if (!missing.empty()) refuse_to_merge(task_.folder, missing);
}

}  // namespace earthshine::app
