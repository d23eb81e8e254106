// SPDX-License-Identifier: Apache-2.0
// The pictures of a visibility study and the pairs that its report lays over each other.
#pragma once

#include <filesystem>
#include <vector>

#include "app/views/scene.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// What the study asks for; where it asks for nothing, each camera by the first lamp setting at the
// first place and, along an orbit, nearest to midnight, clean and by CCTV.
void fill_pictures(studies::StudyFile& study, const StudyPart& part);

// Throws base::Error (Input) where a wish names a camera, a lamp setting or a position that the
// study does not have. parts: of all scenes; the first one that has the camera draws it.
void check_pictures(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts);

// Where the wishes for a camera are drawn: the first scene that has it draws them.
struct PictureTask {
  const studies::StudyFile& study;
  const std::vector<const StudyPart*>& parts;
  const StudyPart& part;
  const StudyCamera& camera;
  std::filesystem::path folder;  // of the study; pictures/ and points/ are in it
  const Json& frame_cache_key;   // of the camera's picture with all layers
  const Common& common;
};
// Whether all of them are there from an earlier run.
[[nodiscard]] bool pictures_are_there(const PictureTask& task);
// Draws those that are not there into folder/pictures, adds figures of study.json to `figures`.
// view: null where all are there.
void draw_pictures(const PictureTask& task, const studies::BasisView* view, Json& figures);

// "pairs" of study.json, of the figures that were drawn.
[[nodiscard]] Json pairs_json(const studies::StudyFile& study, const Json& figures);

}  // namespace earthshine::app
