// SPDX-License-Identifier: Apache-2.0
// The noise of the pictures in a study: in cd/m^2, and relative to the light if there is any.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace earthshine::studies {

// The reason why a condition's picture is finished.
enum class FinishedBy {
  Error,     // its error is as wanted
  Verdicts,  // each target has the same verdict at both ends of its contrast's 95 % interval
  Nothing    // neither: its error is larger, and a verdict may change
};
// "error", "verdicts", "nothing".
[[nodiscard]] std::string_view word_of(FinishedBy finished);

struct ConditionNoise {
  std::optional<double> relative;  // over the picture's mean; empty above 1
  std::optional<double> cd_m2;     // RMS over the pixels that count; empty if unknown
  FinishedBy finished_by = FinishedBy::Error;
};

// rms, mean: of the pixels that count, cd/m^2. If the noise exceeds the light, the picture only
// gives an upper bound of the light, and the ratio would depend on the seed.
[[nodiscard]] ConditionNoise noise_of_condition(double rms, double mean);

// Text about a camera's conditions: the range of their relative noise with the noisiest condition,
// the dark conditions in cd/m^2, and the number of conditions by FinishedBy. "" without data.
[[nodiscard]] std::string noise_text(std::span<const ConditionNoise> noise,
                                     std::span<const std::string> names);
}  // namespace earthshine::studies
