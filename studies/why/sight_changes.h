// SPDX-License-Identifier: Apache-2.0
// One target's sight with one change, for the comparisons of studies/why/why_not.h.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "studies/why/why_not.h"

namespace earthshine::studies {

// All arguments of measure_sight, for one target.
struct Scenario {
  SightPlan plan;  // for this target only
  base::Image radiance;
  std::optional<degrade::Setup> cctv;
  SightOptions options;
};

// A cause, and the function that removes it from a scenario.
struct Change {
  Cause cause = Cause::Small;
  std::string by = {};
  std::optional<double> share = {};
  std::string text = {};  // "hidden by tail (83 % of it)"
  std::function<void(Scenario&)> apply = {};
  std::string without = "without it";  // precedes the probability
};

[[nodiscard]] Scenario scenario_of(const WhyNotInputs& inputs, std::size_t index,
                                   const SightOptions& options);
// Applies all changes: light first, because other changes depend on the picture.
[[nodiscard]] Scenario without_all(const Scenario& scenario, const std::vector<Change>& changes);

// Empty if it does not apply.
[[nodiscard]] std::optional<Change> without_hiding(const WhyNotInputs& inputs, std::size_t index);
[[nodiscard]] std::optional<Change> without_black_back(const WhyNotInputs& inputs,
                                                       std::size_t index,
                                                       const std::vector<SourceOnTarget>& sources);
// At most `most` changes, by falling gain of light.
[[nodiscard]] std::vector<Change> with_light(const WhyNotInputs& inputs, std::size_t index,
                                             const std::vector<SourceOnTarget>& sources,
                                             std::size_t most = 4);

// Changes for a bright thing: the iris that it closes (by a quarter of a stop or more), its stray
// light over the picture, and both. Things by their weight in the meter; the last entry is all
// things brighter than the target together.
struct BrightThings {
  std::string names;
  double stops = 0.0;
  std::vector<Change> changes;  // the last one removes most
};
[[nodiscard]] std::vector<BrightThings> without_bright_things(const WhyNotInputs& inputs,
                                                              std::size_t index, std::size_t most);
// Saturation, lag, blur by part, noise, the room's light: those that the CCTV has.
[[nodiscard]] std::vector<Change> with_better_cctv(const WhyNotInputs& inputs, std::size_t index);
[[nodiscard]] std::vector<Change> without_limits_of_the_eye(const WhyNotInputs& inputs,
                                                            std::size_t index);

// Signal S per cd/m^2 with this exposure.
[[nodiscard]] double signal_per_luminance(const degrade::CctvCamera& camera,
                                          const degrade::Exposure& exposure);
// Fixes iris and gain at this exposure.
void hold_exposure(Scenario& scenario, const degrade::Exposure& exposure);
// visit(values) for the channels with light.
template <class Visit>
void for_light(base::Image& image, Visit visit) {
  for (base::Channel& channel : image.channels) {
    if (channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "Y") {
      visit(channel.values);
    }
  }
}

// "the Sun does not reach it (shadow of tail)"; empty if the source lights most of the points
// facing it.
[[nodiscard]] std::string darkness_of(const SourceOnTarget& source);

}  // namespace earthshine::studies
