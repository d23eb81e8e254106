// SPDX-License-Identifier: Apache-2.0
// A finished visibility study as the source of a console: its study file again, its light, and the
// verdicts of its conditions.
#pragma once

#include <filesystem>

#include "app/console/layers.h"
#include "app/study/results.h"

namespace earthshine::app {

[[nodiscard]] bool is_study_folder(const std::filesystem::path& path);

// The results and the study that gave them. Throws base::Error (Input) if the folder has no
// complete results, or if the study's file is missing.
struct FinishedStudy {
  std::string folder;
  StudyResults results;
  studies::StudyFile study;
  std::uint64_t seed = 1;
};
// cameras: some of its cameras; empty: all.
[[nodiscard]] FinishedStudy finished_study(const std::string& folder,
                                           const std::vector<std::string>& cameras);

// Throws base::Error (Input) if the files of the scene have changed since the study: names what.
void check_unchanged(const FinishedStudy& finished, const StudyPart& part);

// The lamp settings with their factors on the page's lights, and the verdicts and reasons of
// each camera's targets by setting and place.
[[nodiscard]] Json study_json(const FinishedStudy& finished, const StudyPart& part);

}  // namespace earthshine::app
