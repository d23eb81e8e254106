// SPDX-License-Identifier: Apache-2.0
// Tables of `earthshine study compare`: JSON rows, which become CSV, and text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/study.h"
#include "studies/compare/compare.h"

namespace earthshine::app {

// One row per method at the scene's settings, then the noise floor.
[[nodiscard]] Json method_rows(const studies::Comparison& comparison);
// One row per target and method at the scene's settings.
[[nodiscard]] Json target_rows(const studies::Comparison& comparison);
// One row per number of lights: error against N.
[[nodiscard]] Json lights_rows(const studies::Comparison& comparison);
// Smallest number of lights with an error within a twentieth of the error with the most lights;
// none if only the largest number qualifies, or only one number was tried.
[[nodiscard]] std::optional<int> levels_out_at(const studies::Comparison& comparison,
                                               bool over_area);

// Sentences: the effect of more lights, the rule, and a verdict per target.
[[nodiscard]] std::vector<std::string> findings(const studies::Comparison& comparison);
// The table of the methods, and the findings.
[[nodiscard]] std::string summary(const studies::Comparison& comparison);

}  // namespace earthshine::app
