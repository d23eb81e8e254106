// SPDX-License-Identifier: Apache-2.0
// Texts of a study's results, common to terminal and report.
#pragma once

#include <string>
#include <vector>

#include "app/study/results.h"

namespace earthshine::app {

// A scene's name; its file if it has no name; both if another scene has the same name.
[[nodiscard]] std::string scene_title(const StudyResults& study, std::size_t scene);

// "117 to 63 deg, 200 to 210 deg", each angle in [0, 360); "the whole orbit".
[[nodiscard]] std::string arcs_text(const std::vector<studies::Arc>& arcs);

// The value that decides the verdict, with its threshold: "contrast on the monitor 0.23, threshold
// 0.34". By docs/studies.md ("Probability") it is the smallest of contrast, signal to noise and
// cycles across the target, relative to its threshold, for the first task that fails. "" if the
// target is identified or was not measured.
[[nodiscard]] std::string deciding_figure(const TargetFindings& found);

}  // namespace earthshine::app
