// SPDX-License-Identifier: Apache-2.0
// The requested pictures of a visibility study, and the pairs for the report's sliders.
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

// Whether the part has the request's place.
[[nodiscard]] bool has_place(const StudyPart& part, const studies::PictureWish& wish);

// Throws base::Error (Input) if a request names a camera, a lamp setting or a position that the
// study does not have. parts: of all scenes; the first one with the camera draws it.
void check_pictures(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts);

// The pictures of one camera, drawn by the first scene that has it.
struct PictureTask {
  const studies::StudyFile& study;
  const std::vector<const StudyPart*>& parts;
  const StudyPart& part;
  const StudyCamera& camera;
  std::filesystem::path folder;  // of the study; contains pictures/ and points/
  const Json& frame_cache_key;   // of the camera's picture with all layers
  const ResultCache& store;      // points/
  const Common& common;
};
// Whether all of them exist from an earlier run.
[[nodiscard]] bool pictures_are_there(const PictureTask& task);
// Draws the missing ones into folder/pictures and adds all to `figures`. view: null if all exist.
void draw_pictures(const PictureTask& task, const studies::BasisView* view,
                   std::vector<FigureEntry>& figures);

// Writes the PNGs of a study's clean pictures from their EXR files: with their own white, and again
// with a common white; if `tone` sets a white, only with that. Sets the whites.
void expose_figures(const std::filesystem::path& folder, const ToneChoice& tone,
                    std::vector<FigureEntry>& figures);

// Pairs of drawn pictures.
[[nodiscard]] std::vector<PairEntry> pairs_of(const studies::StudyFile& study,
                                              const std::vector<FigureEntry>& figures);

}  // namespace earthshine::app
