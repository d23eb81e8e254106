// SPDX-License-Identifier: Apache-2.0
// Words for a study's results that the terminal and the report share.
#pragma once

#include <string>
#include <vector>

#include "app/study/results.h"

namespace earthshine::app {

// A scene's name; its file where it has none, and both where another scene has the same name.
[[nodiscard]] std::string scene_title(const StudyResults& study, std::size_t scene);

// "117 to 63 deg, 200 to 210 deg", each angle from 0 to below 360; "the whole orbit".
[[nodiscard]] std::string arcs_text(const std::vector<studies::Arc>& arcs);

// The figure that decides the verdict, beside its threshold: "contrast on the monitor 0.23,
// threshold 0.34". By the formulas of docs/studies.md ("Probability") it is the least of contrast,
// signal to noise and cycles across the target for the first task that fails. "" where the target
// is identified or nothing was measured.
[[nodiscard]] std::string deciding_figure(const TargetFindings& found);

}  // namespace earthshine::app
