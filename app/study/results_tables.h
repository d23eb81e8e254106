// SPDX-License-Identifier: Apache-2.0
// The results of a visibility study as a table and as text.
#pragma once

#include <string>
#include <vector>

#include "app/study/results.h"

namespace earthshine::app {

// A sentence for each camera and target of which a black back is seen: that is not the target as it
// will look.
[[nodiscard]] std::vector<std::string> black_back_notes(const StudyResults& results);

// results.csv: a row per condition, camera and target.
[[nodiscard]] std::string results_csv(const StudyResults& results);

// For people: a line per camera, target and lamp setting, the answers, and black backs.
[[nodiscard]] std::string study_text(const StudyResults& results);

}  // namespace earthshine::app
