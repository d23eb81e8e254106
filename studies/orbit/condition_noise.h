// SPDX-License-Identifier: Apache-2.0
// The noise of the pictures that a study judges: relative where there is light, in cd/m^2 always.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace earthshine::studies {

// What finished a condition's picture.
enum class FinishedBy {
  Error,     // its error is as asked
  Verdicts,  // each target's verdict is the same at both ends of its contrast's 95 % interval
  Nothing    // neither: its error is larger, and a verdict may change
};
// "error", "verdicts", "nothing".
[[nodiscard]] std::string_view word_of(FinishedBy finished);

struct ConditionNoise {
  std::optional<double> relative;  // over the picture's mean; none where it would be more than 1
  std::optional<double> cd_m2;     // rms over the pixels that count; none where nothing is known
  FinishedBy finished_by = FinishedBy::Error;
};

// rms, mean: of the pixels that count, cd/m^2. A picture of more noise than light tells only that
// its light is not much more than the noise: what it is of that light depends on the seed alone.
[[nodiscard]] ConditionNoise noise_of_condition(double rms, double mean);

// Of a camera's conditions and their names: the range of the relative ones, which is noisiest, the
// dark ones in cd/m^2, and how many were finished by what. "" where nothing is known.
[[nodiscard]] std::string noise_text(std::span<const ConditionNoise> noise,
                                     std::span<const std::string> names);
}  // namespace earthshine::studies
