// SPDX-License-Identifier: Apache-2.0
// The reasons why a target is not seen better. Each cause is removed alone, and the sight is
// measured again.
//   out-of-view  it would not be in view even alone
//   hidden       removes objects in front of a tenth of it or more, by name
//   black-back   a one-sided surface seen from behind reflects like its front
//   unlit        a source reaches all points that face it, is on, or is a lamp at a quarter
//                of its distance; the largest gain first
//   iris         opens the iris as without a bright thing, by name; its light remains, unless only
//                both changes together help
//   glare        removes a bright thing's light from the lens' glare and the tube's bloom and smear
//   saturated    exposure so low that target and surround are below white, at least two stops
//   lag          the tube has no lag; for a target that moves
//   blur         one of lens, tube, video line and monitor has no blur
//   noise        no noise
//   room-light   the room does not light the monitor
//   contrast     the eye sees any difference; a target as bright as its surround is put on black
//   small        any number of cycles across it suffices
//
// A cause is a reason if its removal raises the probability of the first failing task by
// `least_gain` or above the wanted one. Causes that reach the wanted probability displace those
// that do not. If no single cause reaches it, all are removed together; causes that can return, the
// last of the order above first, without a failure of the task are no reasons. `contrast` and
// `small`, limits of the viewer, are tried only if nothing else helps. Of bright things, the
// brightest sufficient one is named. A black back that makes the target doubtful is always a
// reason. Reasons have the order above.
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
  std::string by;  // object or light group; for blur: lens, tube, line or monitor; may be empty
  std::optional<double> share;  // hidden: of the target's pixels; unlit: of the target, in the dark
  std::optional<double> probability_without;  // empty if unknown
  std::string text;                           // "hidden by tail (83 % of it): without it 0.94"
};

struct WhyNot {
  std::vector<Reason> reasons;
  std::string text;  // one line; empty if the target is identified
  // Probability of the failing task without several reasons together; empty if one suffices.
  std::optional<double> probability_without_all;
};

// A light group and its light on one target.
struct SourceOnTarget {
  std::string group;
  std::string off =
      {};  // cause if it gives no light: "switched off", "in the Earth's shadow"; otherwise empty
  double luminance = 0.0;   // of the target by this group, cd/m^2, all paths
  double lit = 0.0;         // share of its seen points with direct light (0 when off)
  double facing = 0.0;      // share without occluders
  double direct = 0.0;      // luminance by its direct light (0 when off)
  double unshadowed = 0.0;  // `direct` if it were on, without occluders
  double on_back = 0.0;     // additional `direct` if black backs reflected like their fronts
  double straight = 0.0;    // part of `direct` that no object's reflected light includes
  double distance_m = 0.0;  // of a lamp, to the centre of the seen points; 0: no lamp, or unknown
  std::vector<std::string> shadow_of = {};  // occluders, most first
  // The picture with this group on, if it is off and the picture is available; otherwise only the
  // target's luminance changes.
  const base::Image* when_on = nullptr;
};

struct WhyNotOptions {
  double wanted = 0.5;  // probability of the task
  double least_gain = 0.1;
  std::size_t bright_things = 6;  // number of things tried for the iris
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

// sources: of target `index` of the plan. Computes nothing for a target that is identified.
[[nodiscard]] WhyNot why_not(const WhyNotInputs& inputs, std::size_t index,
                             const std::vector<SourceOnTarget>& sources,
                             const WhyNotOptions& options = {});

}  // namespace earthshine::studies
