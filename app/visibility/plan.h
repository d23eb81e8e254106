// SPDX-License-Identifier: Apache-2.0
// What a visibility study would do and what that costs: --dry-run.
#pragma once

#include <filesystem>
#include <vector>

#include "app/views/scene.h"
#include "studies/orbit/study_file.h"

namespace earthshine::app {

// Solves and pictures are priced by a small run of each (studies/cost/cost.h), conditions by one.
// What the folder already holds is named and costs nothing.
[[nodiscard]] Json plan_json(const studies::StudyFile& study,
                             const std::vector<const StudyPart*>& parts,
                             const std::filesystem::path& folder, const Common& common);

// What the study asks for; where it asks for nothing, each camera by the first lamp setting at the
// first place and, along an orbit, nearest to midnight, clean and by CCTV.
void fill_pictures(studies::StudyFile& study, const StudyPart& part);

}  // namespace earthshine::app
