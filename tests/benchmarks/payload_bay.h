// SPDX-License-Identifier: Apache-2.0
// Scene of the benchmarks: the payload bay by day, with few rays for short runs.
#pragma once

#include "scenes/effects/world.h"
#include "scenes/read/scene_file.h"

namespace earthshine {

struct PayloadBay {
  scenes::Scene scene;
  scenes::LightGroups groups;
  scenes::Effects effects;
  scenes::RayQuery query;

  operator scenes::World() const { return {scene, groups, effects, query}; }
};

inline const PayloadBay& payload_bay() {
  static const PayloadBay bay = [] {
    scenes::Scene scene =
        scenes::read_scene(EARTHSHINE_SOURCE_DIR "/scenes/library/sts46/day-earthshine.toml");
    scenes::LightGroups groups = scenes::find_light_groups(scene);
    scenes::Effects effects = scenes::find_effects(scene, groups);
    scenes::RayQuery query(scene);
    return PayloadBay{std::move(scene), std::move(groups), effects, std::move(query)};
  }();
  return bay;
}

}  // namespace earthshine
