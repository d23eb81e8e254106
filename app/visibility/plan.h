// SPDX-License-Identifier: Apache-2.0
// --dry-run: the work of a visibility study and its predicted cost.
#pragma once

#include <filesystem>
#include <vector>

#include "app/views/scene.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// A small run of each predicts the cost of solves and pictures (studies/cost/cost.h), a single one
// the cost of conditions. Stored results are listed at no cost.
[[nodiscard]] Json plan_json(const studies::StudyFile& study,
                             const std::vector<const StudyPart*>& parts,
                             const std::filesystem::path& folder, const Common& common);

// The requested pictures. By default each camera, clean and by CCTV, with the first lamp setting at
// the first position and, along an orbit, at the one nearest to midnight.
void fill_pictures(studies::StudyFile& study, const StudyPart& part);

}  // namespace earthshine::app
