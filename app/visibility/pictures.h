// SPDX-License-Identifier: Apache-2.0
// The pictures of a visibility study and the pairs that its report lays over each other.
#pragma once

#include <filesystem>
#include <vector>

#include "app/options.h"
#include "app/parts/result_cache.h"
#include "app/study/results.h"
#include "app/views/scene.h"
#include "studies/orbit/condition.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

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
  const ResultCache& store;      // points/
  const Common& common;
};
// Whether all of them are there from an earlier run.
[[nodiscard]] bool pictures_are_there(const PictureTask& task);
// Draws those that are not there into folder/pictures, adds them to `figures`.
// view: null where all are there.
void draw_pictures(const PictureTask& task, const studies::BasisView* view,
                   std::vector<FigureEntry>& figures);

// Writes the PNGs of the clean pictures among a study's figures, of their EXR files: each by its own
// white, and again by one white for all; or, where `tone` has one, only by that. Fills the whites.
void expose_figures(const std::filesystem::path& folder, const ToneChoice& tone,
                    std::vector<FigureEntry>& figures);

// Of the figures that were drawn.
[[nodiscard]] std::vector<PairEntry> pairs_of(const studies::StudyFile& study,
                                              const std::vector<FigureEntry>& figures);

}  // namespace earthshine::app
