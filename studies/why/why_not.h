// SPDX-License-Identifier: Apache-2.0
// Why a target is not seen better: one cause at a time is taken away and the sight measured again.
//   out-of-view  it would not show even alone
//   hidden       what stands in front of a tenth of it or more is taken away, by name
//   unlit        a source reaches all of it that faces the source, or is switched on
//   iris         the iris stands as it would without a bright thing, by name; its light stays
//   saturated    exposure so low that target and surround are below white, at least two stops
//   blur         lens, tube, video line and phosphor spread nothing
//   noise        no noise
//   contrast     the eye sees any difference, on the monitor or at the window
//   small        any number of cycles across it will do
// A cause is a reason if without it the probability of the first task that fails rises by
// `least_gain` or over the wanted one; those that bring it over the wanted one drop those that do
// not, and `contrast` and `small`, which are the viewer's, stand back behind the others that do. If
// no single one does, causes are taken away one after the other, the most helpful first,
// until the task is done, and all of them are reasons. Reasons stand in the order above.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/sight/sight.h"
#include "studies/why/lit_points.h"

namespace earthshine::studies {

enum class Cause { OutOfView, Hidden, Unlit, Iris, Saturated, Blur, Noise, Contrast, Small };
// "out-of-view", "hidden", "unlit", "iris", "saturated", "blur", "noise", "contrast", "small".
[[nodiscard]] std::string_view word_of(Cause cause);

struct Reason {
  Cause cause = Cause::Small;
  std::string by;               // object or light group; may be empty
  std::optional<double> share;  // hidden: of the target's pixels; unlit: of it, in the dark
  std::optional<double> probability_without;  // none where it cannot be known
  std::string text;                           // "hidden by tail (83 % of it): without it 0.94"
};

struct WhyNot {
  std::vector<Reason> reasons;
  std::string text;  // one line; empty when the target is identified
  // That of the failing task with all of several reasons taken away; none where one is enough.
  std::optional<double> probability_without_all;
};

// A light group and what it does to one target.
struct SourceOnTarget {
  std::string group;
  std::string off =
      {};  // why it gives no light: "switched off", "in the Earth's shadow"; else empty
  double luminance = 0.0;   // of the target by this group, cd/m^2, all paths
  double lit = 0.0;         // share of its seen points that get direct light (0 when off)
  double facing = 0.0;      // share that would if nothing stood between
  double direct = 0.0;      // luminance by its direct light alone (0 when off)
  double unshadowed = 0.0;  // the same if it were on with nothing in between
  std::vector<std::string> shadow_of = {};  // objects in between, most first
  // The picture with this group on, where it is off and the picture is at hand; otherwise only the
  // target is thought to be lit.
  const base::Image* when_on = nullptr;
};

struct WhyNotOptions {
  double wanted = 0.5;  // probability of the task
  double least_gain = 0.1;
  std::size_t bright_things = 6;  // how many are tried for the iris
  SightOptions sight;
};

struct WhyNotInputs {
  const scenes::Scene& scene;  // names
  const scenes::Camera& camera;
  const SightPlan& plan;
  const base::Image& radiance;
  const std::optional<degrade::Setup>& cctv;
  const CameraSight& sight;            // measure_sight of the above
  std::optional<scenes::Sun> sun;      // } of this condition: bright things in the sky
  std::optional<scenes::Earth> earth;  // }
};

// sources: of target `index` of the plan. Nothing is computed for a target that is identified.
[[nodiscard]] WhyNot why_not(const WhyNotInputs& inputs, std::size_t index,
                             const std::vector<SourceOnTarget>& sources,
                             const WhyNotOptions& options = {});

}  // namespace earthshine::studies
