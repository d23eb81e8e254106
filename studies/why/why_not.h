// SPDX-License-Identifier: Apache-2.0
// Why a target is not seen better: one cause at a time is taken away and the sight measured again.
//   out-of-view  it would not show even alone
//   hidden       what stands in front of a tenth of it or more is taken away, by name
//   black-back   a one-sided surface seen from behind reflects as its front does
//   unlit        a source reaches all of it that faces the source, is switched on, or is a lamp at
//                a quarter of its distance; what would give most first
//   iris         the iris stands as it would without a bright thing, by name; its light stays,
//                unless only both together help
//   glare        the lens' glare, the tube's bloom and smear have nothing of a bright thing
//   saturated    exposure so low that target and surround are below white, at least two stops
//   lag          the tube keeps nothing of the field before; of a target that moves
//   blur         one of lens, tube, video line and monitor spreads nothing
//   noise        no noise
//   room-light   the room does not light the monitor
//   contrast     the eye sees any difference, and what is as bright as its surround stands on black
//   small        any number of cycles across it will do
// A cause is a reason if without it the probability of the first task that fails rises by
// `least_gain` or over the wanted one; those that bring it over the wanted one drop those that do
// not. If no single one does, all are taken away together, and those that are then put back, the
// last of the order above first, without the task failing again are no reasons. `contrast` and
// `small`, which are the viewer's, are asked only where nothing before him would do. Of bright
// things the brightest that is enough is named. A black back that makes the target doubtful is
// always a reason. Reasons stand in the order above.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/sight/sight.h"
#include "studies/why/lit_points.h"

namespace earthshine::studies {

enum class Cause {
  OutOfView,
  Hidden,
  BlackBack,
  Unlit,
  Iris,
  Glare,
  Saturated,
  Lag,
  Blur,
  Noise,
  RoomLight,
  Contrast,
  Small
};
// As above: "out-of-view", "hidden", "black-back", ...
[[nodiscard]] std::string_view word_of(Cause cause);

struct Reason {
  Cause cause = Cause::Small;
  std::string by;  // object or light group; of blur lens, tube, line or monitor; may be empty
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
  double on_back = 0.0;     // what `direct` would be more if black backs were as their fronts
  double straight = 0.0;    // of `direct`, what no object counts as its reflected light
  double distance_m = 0.0;  // of a lamp, to the middle of what is seen; 0: none, or not known
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
