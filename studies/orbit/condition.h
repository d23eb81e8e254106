// SPDX-License-Identifier: Apache-2.0
// A camera's view of its targets in one condition, that is, an orbit position with a lamp setting:
// a weighted sum of the layers of one picture.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "degrade/chain.h"
#include "scenes/ray_query.h"
#include "studies/light/light_basis.h"
#include "studies/sight/sight.h"
#include "studies/why/last_bounce.h"
#include "studies/why/lit_points.h"
#include "studies/why/why_not.h"

namespace earthshine::studies {

// Data of a camera for all conditions.
struct BasisView {
  const scenes::Camera* camera = nullptr;
  base::Image layers;  // of the basis' scene: a layer per light group, and the layer "object"
  SightPlan plan;
  // Of each target: points of its visible surface, its mean light by group over the measured
  // pixels, and the reach of each lamp of the scene and of each emitting material.
  struct Target {
    std::vector<SeenPoint> points;
    std::vector<Rgb> by_group;
    std::vector<std::optional<Reach>> lamps, emitters;
    std::optional<EarthBlockers> earth;     // if the Earth has the same direction at several places
    std::optional<LastBounce> last_bounce;  // at the points; empty without a solution
  };
  std::vector<Target> targets;
  std::vector<bool> straight_emitters;  // per material: radiosity::emitter_is_explicit
};
// layers: from raytrace::render for basis.scene() with per_light and the layer "object". query: of
// the scene, whose geometry the basis shares. solution: of the basis' scene; null:
// TargetOutcome::light_from stays empty.
[[nodiscard]] BasisView make_basis_view(const LightBasis& basis, const scenes::RayQuery& query,
                                        const scenes::Camera& camera, base::Image layers,
                                        const radiosity::Solution* solution = nullptr);

struct TargetOutcome {
  std::vector<SourceOnTarget> sources;  // "sun", "earth", lamps and emitters by light group
  std::vector<LightShare> light_from;   // its luminance by source and last bounce
  std::optional<double> lit_fraction;   // by all sources that are on; empty out of view
  WhyNot why;                           // empty unless requested
  std::optional<std::size_t> why_of;    // of judge_conditions: the condition with the same reasons;
                                        // empty: own reasons
  std::optional<BasisError> basis_error;
};

struct Outcome {
  CameraSight sight;
  std::vector<TargetOutcome> targets;  // in the order of sight.targets
  double sun_share = 0.0;              // unoccluded share of the Sun's disc
};

struct ConditionAt {
  std::size_t place = 0, setting = 0;
};

struct ConditionOptions {
  double lamps = 1.0;  // factor on all lamps of the setting
  // The targets with TargetOutcome::why; each costs about as much as ten conditions.
  enum class Explain { None, Unseen, NotIdentified } explain = Explain::NotIdentified;
  WhyNotOptions why;
  // Per target, the `deviation` argument of measure_sight in that condition; empty: pictures are
  // exact.
  std::function<std::vector<double>(const ConditionAt&)> deviation = {};
  std::function<void()> before_each = {};  // called per condition, by many threads; an exception
                                           // ends the call
};

// Evaluates conditions in order. Reasons, which cost most, are found once per run of similar
// conditions; the other conditions refer to the first one. Similar conditions have the same
// setting, verdict and iris (within a quarter of a stop), and the same sources off for the same
// causes. Their probabilities and shares of direct light are within 0.05 of the first condition's,
// and the luminances of target and surround within a tenth.
[[nodiscard]] std::vector<Outcome> judge_conditions(const LightBasis& basis,
                                                    const scenes::RayQuery& query,
                                                    const BasisView& view,
                                                    const std::vector<ConditionAt>& conditions,
                                                    const std::optional<degrade::Setup>& cctv,
                                                    const ConditionOptions& options);

}  // namespace earthshine::studies
