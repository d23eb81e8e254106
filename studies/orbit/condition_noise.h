// SPDX-License-Identifier: Apache-2.0
// The noise of the pictures that a study judges: relative where there is light, in cd/m^2 always.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace earthshine::studies {

// Why the samples of a condition's picture are enough.
enum class Enough {
  Error,    // its error is as asked
  Verdict,  // it is larger, but with no target's verdict the other at the ends of its 95 % interval
  No
};
// "error", "verdict", "no".
[[nodiscard]] std::string_view word_of(Enough enough);

struct ConditionNoise {
  std::optional<double> relative;  // over the picture's mean; none where it would be more than 1
  std::optional<double> cd_m2;     // rms over the pixels that count; none where nothing is known
  Enough enough = Enough::Error;
};

// rms, mean: of the pixels that count, cd/m^2. A picture of more noise than light tells only that
// its light is not much more than the noise: what it is of that light depends on the seed alone.
[[nodiscard]] ConditionNoise noise_of_condition(double rms, double mean);

// Of a camera's conditions and their names: the range of the relative ones, which is noisiest, and
// the dark ones in cd/m^2. "" where nothing is known.
[[nodiscard]] std::string noise_text(std::span<const ConditionNoise> noise,
                                     std::span<const std::string> names);
}  // namespace earthshine::studies
