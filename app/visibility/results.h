// SPDX-License-Identifier: Apache-2.0
// Assembles a visibility study's results from the cameras' findings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/results.h"
#include "app/views/frames.h"
#include "app/visibility/conditions.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// Results of one camera.
struct CameraFindings {
  const StudyPart& part;
  const StudyCamera& camera;
  double relative_noise = 0.0, render_seconds = 0.0;
  Judged conditions;
  std::vector<ThumbnailEntry> thumbnails = {};  // with conditions numbered as in `conditions`
};

// Results before any camera: scenes, targets, conditions, settings and provenance.
[[nodiscard]] StudyResults begin_results(const studies::StudyFile& study,
                                         const std::vector<const StudyPart*>& parts,
                                         const std::string& command, std::uint64_t seed);

// The next camera with its results and thumbnails, or one more pose of a camera that is there;
// conditions of its scene get their earth_error.
void add_camera(StudyResults& results, const CameraFindings& found);

// limits: that each part's solution reached, as `parts`.
[[nodiscard]] std::vector<std::string> notes_of(
    const StudyResults& results, const std::vector<const StudyPart*>& parts,
    const std::vector<std::vector<std::string>>& limits);

}  // namespace earthshine::app
