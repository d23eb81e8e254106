// SPDX-License-Identifier: Apache-2.0
// What every stage of a run reads: the scene with its light groups, the effects that were decided
// for the run, and ray queries. References alone, cheap to copy; all must outlive it.
#pragma once

#include "scenes/effects/effects.h"
#include "scenes/effects/light_groups.h"
#include "scenes/ray_query.h"

namespace earthshine::scenes {

struct World {
  const Scene& scene;
  const LightGroups& groups;
  const Effects& effects;
  const RayQuery& query;
};

}  // namespace earthshine::scenes
