// SPDX-License-Identifier: Apache-2.0
// One target's sight with one thing about it changed: what studies/why/why_not.h compares.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "studies/why/why_not.h"

namespace earthshine::studies {

// All that measure_sight takes, for one target.
struct Scenario {
  SightPlan plan;  // of this target alone
  base::Image radiance;
  std::optional<degrade::Setup> cctv;
  SightOptions options;
};

// A cause, and what a scenario is without it.
struct Change {
  Cause cause = Cause::Small;
  std::string by;
  std::optional<double> share;
  std::string text;  // "hidden by tail (83 % of it)"
  std::function<void(Scenario&)> apply;
};

[[nodiscard]] Scenario scenario_of(const WhyNotInputs& inputs, std::size_t index,
                                   const SightOptions& options);

// None where it is not called for.
[[nodiscard]] std::optional<Change> without_hiding(const WhyNotInputs& inputs, std::size_t index);
[[nodiscard]] std::vector<Change> with_light(const WhyNotInputs& inputs, std::size_t index,
                                             const std::vector<SourceOnTarget>& sources);
// One for each of the `most` brightest things for which the iris closes by a quarter of a stop or
// more, and one for all that are brighter than the target together.
[[nodiscard]] std::vector<Change> with_iris_opened(const WhyNotInputs& inputs, std::size_t index,
                                                   std::size_t most);
[[nodiscard]] std::optional<Change> without_saturation(const WhyNotInputs& inputs,
                                                       std::size_t index);
[[nodiscard]] std::vector<Change> without_blur_or_noise(const WhyNotInputs& inputs);
[[nodiscard]] std::vector<Change> without_limits_of_the_eye(const WhyNotInputs& inputs,
                                                            std::size_t index);

// "the Sun does not reach it (shadow of tail)"; empty where the source lights most of what faces
// it.
[[nodiscard]] std::string darkness_of(const SourceOnTarget& source);

}  // namespace earthshine::studies
