// SPDX-License-Identifier: Apache-2.0
// The tables of `earthshine study compare`: JSON rows, which become CSV, and its text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/study.h"
#include "studies/compare/compare.h"

namespace earthshine::app {

// A row per method at the scene's settings; last the noise floor.
[[nodiscard]] Json method_rows(const studies::Comparison& comparison);
// A row per target and method at the scene's settings.
[[nodiscard]] Json target_rows(const studies::Comparison& comparison);
// A row per number of lights: error against N.
[[nodiscard]] Json lights_rows(const studies::Comparison& comparison);
// From which number of lights on the error is within a twentieth of that with the most; none if
// only that one is, or only one number was tried.
[[nodiscard]] std::optional<int> levels_out_at(const studies::Comparison& comparison,
                                               bool over_area);

// Sentences: what more lights would change, the rule, and a verdict per target.
[[nodiscard]] std::vector<std::string> findings(const studies::Comparison& comparison);
// The table of the methods and the findings.
[[nodiscard]] std::string summary(const studies::Comparison& comparison);

}  // namespace earthshine::app
