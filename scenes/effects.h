// SPDX-License-Identifier: Apache-2.0
// Which effects a scene calls for, decided here and nowhere else. An effect that does not run casts
// no rays.
#pragma once

#include <string>
#include <vector>

#include "scenes/light_groups.h"
#include "scenes/scene.h"

namespace earthshine::scenes {

struct Effects {
  bool interreflection = false;
  bool sun = false;
  bool penumbra = false;
  bool earth = false;
  bool earth_by_gather =
      false;  // the Earth is wide: escaping gather rays read it; else it is sampled
  bool lamps = false;
  bool emitters = false;
  bool phong = false;
  bool mirror = false;
  bool refraction = false;
  bool ambient = false;
  bool depth_of_field = false;  // of at least one camera
  bool cctv = false;            // of at least one camera
  bool range_sensor = false;    // of at least one camera
};

[[nodiscard]] Effects find_effects(const Scene& scene, const LightGroups& groups);

// One row of `earthshine plan`: the effect, whether it runs, and the fact that decided.
struct EffectRow {
  std::string effect;
  bool runs = false;
  std::string reason;
};
[[nodiscard]] std::vector<EffectRow> describe_effects(const Scene& scene,
                                                      const LightGroups& groups);

}  // namespace earthshine::scenes
