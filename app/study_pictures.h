// SPDX-License-Identifier: Apache-2.0
// The pictures of a visibility study and the pairs that its report lays over each other.
#pragma once

#include <filesystem>
#include <vector>

#include "app/study_scene.h"
#include "studies/condition.h"
#include "studies/study_file.h"

namespace earthshine::app {

// What the study asks for; where it asks for nothing, each camera by the first lamp setting at the
// first place and, along an orbit, nearest to midnight, clean and by CCTV.
void fill_pictures(studies::StudyFile& study, const StudyPart& part);

// Throws base::Error (Input) where a wish names a camera, a lamp setting or a position that the
// study does not have. parts: of all scenes; the first one that has the camera draws it.
void check_pictures(const studies::StudyFile& study, const std::vector<const StudyPart*>& parts);

// Draws the wishes for one camera into folder/pictures, adds figures of study.json to `figures`.
void draw_pictures(const studies::StudyFile& study, const StudyPart& part,
                   const StudyCamera& camera, const studies::BasisView& view,
                   const std::filesystem::path& folder, const Common& common, Json& figures);

// "pairs" of study.json, of the figures that were drawn.
[[nodiscard]] Json pairs_json(const studies::StudyFile& study, const Json& figures);

}  // namespace earthshine::app
