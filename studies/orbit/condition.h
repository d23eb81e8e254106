// SPDX-License-Identifier: Apache-2.0
// What one camera makes of its targets in one condition: a place in the orbit and a lamp setting,
// as a weighted sum of the layers of one picture.
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

// Of a camera, whatever the condition.
struct BasisView {
  const scenes::Camera* camera = nullptr;
  base::Image layers;  // of the basis' scene, a layer per light group, with the layer "object"
  SightPlan plan;
  // Of each target: points of its seen surface, its mean light by group over the pixels that it is
  // measured over, and what each lamp of the scene and each emitting material does to it.
  struct Target {
    std::vector<SeenPoint> points;
    std::vector<Rgb> by_group;
    std::vector<std::optional<Reach>> lamps, emitters;
    std::optional<EarthBlockers> earth;     // where the Earth stands still over several places
    std::optional<LastBounce> last_bounce;  // of the points; none without a solution
  };
  std::vector<Target> targets;
  std::vector<bool> straight_emitters;  // per material: radiosity::emitter_is_explicit
};
// layers: as raytrace::render gives them for basis.scene() with per_light and the layer "object".
// query: of the scene, whose geometry the basis does not change. solution: of the basis' scene;
// null: TargetOutcome::light_from stays empty.
[[nodiscard]] BasisView make_basis_view(const LightBasis& basis, const scenes::RayQuery& query,
                                        const scenes::Camera& camera, base::Image layers,
                                        const radiosity::Solution* solution = nullptr);

struct TargetOutcome {
  std::vector<SourceOnTarget> sources;  // "sun", "earth", lamps and emitters by light group
  std::vector<LightShare> light_from;   // by source and by last bounce, of its luminance
  std::optional<double> lit_fraction;   // by any source that is on; none out of view
  WhyNot why;                           // empty unless asked for
  std::optional<std::size_t> why_of;    // of judge_conditions: whose reasons these are; none: own
  std::optional<BasisError> basis_error;
};

struct Outcome {
  CameraSight sight;
  std::vector<TargetOutcome> targets;  // as sight.targets
  double sun_share = 0.0;              // of the Sun's disc, that the Earth leaves free
};

struct ConditionAt {
  std::size_t place = 0, setting = 0;
};

struct ConditionOptions {
  double lamps = 1.0;  // times all lamps of the setting
  // For which targets TargetOutcome::why is filled: each costs about as much as ten conditions.
  enum class Explain { None, Unseen, NotIdentified } explain = Explain::NotIdentified;
  WhyNotOptions why;
  // Of each target, what measure_sight is given in that condition; none: pictures are exact.
  std::function<std::vector<double>(const ConditionAt&)> deviation = {};
  std::function<void()> before_each = {};  // condition, on many threads; what it throws ends all
};

// Of conditions in their order. Reasons, which cost most, are worked out once per run of like ones:
// of one setting, verdict and iris (a quarter of a stop), the same sources off for the same causes,
// probabilities within 0.05, luminance of target and surround within a tenth, share in direct light
// within 0.05 of those at the run's beginning. Its other conditions say whose theirs are.
[[nodiscard]] std::vector<Outcome> judge_conditions(const LightBasis& basis,
                                                    const scenes::RayQuery& query,
                                                    const BasisView& view,
                                                    const std::vector<ConditionAt>& conditions,
                                                    const std::optional<degrade::Setup>& cctv,
                                                    const ConditionOptions& options);

}  // namespace earthshine::studies
