// SPDX-License-Identifier: Apache-2.0
// The tables of `earthshine study compare`: JSON rows, which become CSV, and its text.
#pragma once

#include <optional>
#include <string>

#include "app/study/study.h"
#include "studies/compare/compare.h"

namespace earthshine::app {

// A row per method at the scene's settings, with what it reaches at equal time and at equal error;
// last the noise floor.
[[nodiscard]] Json method_rows(const studies::Comparison& comparison);
// A row per target and method at the scene's settings.
[[nodiscard]] Json target_rows(const studies::Comparison& comparison);
// The same at equal time and at equal error, or at the least error where that is not reached.
[[nodiscard]] Json equal_target_rows(const studies::Comparison& comparison);
// A row per method and step: error against seconds.
[[nodiscard]] Json curve_rows(const studies::Comparison& comparison);
// A row per number of lights: error against N.
[[nodiscard]] Json lights_rows(const studies::Comparison& comparison);
// From which number of lights on the error is within a twentieth of that with the most; none if
// only that one is, or only one number was tried.
[[nodiscard]] std::optional<int> levels_out_at(const studies::Comparison& comparison,
                                               bool over_area);

[[nodiscard]] double least_error(const studies::Ladder& ladder);
[[nodiscard]] double most_seconds(const studies::Ladder& ladder);

// The tables and a sentence per target.
[[nodiscard]] std::string summary(const studies::Comparison& comparison);

}  // namespace earthshine::app
