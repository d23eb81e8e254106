// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/camera_work.h"

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
  return kept ? std::optional(read_kept<Configurations>((*kept)["ways"])) : std::nullopt;
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

Judged CameraWork::judge(const studies::BasisView& view, Share batches,
                         std::vector<StudyCost>& costs) const {
  return conditions_.judge(pictures_.camera, view, pictures_.frame_cache_key, batches, costs);
}

CameraWork::Configurations CameraWork::conclude(const studies::BasisView& view,
                                                std::vector<FigureEntry>& figures) const {
  draw_pictures(pictures_, &view, figures);
  if (auto kept = known_configurations()) return std::move(*kept);
  Configurations found(pictures_.study.wanted.size());
  add_configurations(pictures_.part, pictures_.study, pictures_.camera, view, found);
  pictures_.store.keep_facts(answers_key_, {{"ways", kept_json(found)}});
  return found;
}

}  // namespace earthshine::app
