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
  std::string by = {};
  std::optional<double> share = {};
  std::string text = {};  // "hidden by tail (83 % of it)"
  std::function<void(Scenario&)> apply = {};
  std::string without = "without it";  // before the probability
};

[[nodiscard]] Scenario scenario_of(const WhyNotInputs& inputs, std::size_t index,
                                   const SightOptions& options);
// Without all of them: light first, so that what else changes goes by the picture as it then is.
[[nodiscard]] Scenario without_all(const Scenario& scenario, const std::vector<Change>& changes);

// None where it is not called for.
[[nodiscard]] std::optional<Change> without_hiding(const WhyNotInputs& inputs, std::size_t index);
[[nodiscard]] std::optional<Change> without_black_back(const WhyNotInputs& inputs,
                                                       std::size_t index,
                                                       const std::vector<SourceOnTarget>& sources);
// At most `most`, what would give most light first.
[[nodiscard]] std::vector<Change> with_light(const WhyNotInputs& inputs, std::size_t index,
                                             const std::vector<SourceOnTarget>& sources,
                                             std::size_t most = 4);

// What a bright thing does to the target: the iris that it closes (by a quarter of a stop or more),
// the light that it strays over the picture, and both. Things by brightness in the meter, and
// behind them all that are brighter than the target, together.
struct BrightThings {
  std::string names;
  double stops = 0.0;
  std::vector<Change> changes;  // the last of them takes away most
};
[[nodiscard]] std::vector<BrightThings> without_bright_things(const WhyNotInputs& inputs,
                                                              std::size_t index, std::size_t most);
// Saturation, lag, blur by part, noise, the room's light: those that the CCTV has.
[[nodiscard]] std::vector<Change> with_better_cctv(const WhyNotInputs& inputs, std::size_t index);
[[nodiscard]] std::vector<Change> without_limits_of_the_eye(const WhyNotInputs& inputs,
                                                            std::size_t index);

// Signal S per cd/m^2 where the iris stands.
[[nodiscard]] double signal_per_luminance(const degrade::CctvCamera& camera,
                                          const degrade::Exposure& exposure);
// Fixes iris and gain there.
void hold_exposure(Scenario& scenario, const degrade::Exposure& exposure);
// visit(values) for the channels of a picture that carry light.
template <class Visit>
void for_light(base::Image& image, Visit visit) {
  for (base::Channel& channel : image.channels) {
    if (channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "Y") {
      visit(channel.values);
    }
  }
}

// "the Sun does not reach it (shadow of tail)"; empty where the source lights most of what faces
// it.
[[nodiscard]] std::string darkness_of(const SourceOnTarget& source);

}  // namespace earthshine::studies
