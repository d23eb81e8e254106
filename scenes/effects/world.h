// SPDX-License-Identifier: Apache-2.0
// Shared input of every stage of a run: the scene with its light groups, the effects of the run,
// and ray queries. Holds references only; all must outlive it.
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
