// SPDX-License-Identifier: Apache-2.0
// [[range_sensor]] tables of a scene to settings. docs/scene-format.md lists the keys.
#pragma once

#include <string>

#include "degrade/range/range_sensor.h"
#include "scenes/scene.h"

namespace earthshine::degrade {

// The [[range_sensor]] of that name. Throws base::Error (Input) for an unknown name or key (with
// the nearest), a value of the wrong kind or out of range, and limits that contradict each other.
[[nodiscard]] RangeSensor resolve_range_sensor(const scenes::Scene& scene, const std::string& name);

// Everything that resolve_range_sensor would refuse, for all tables and all cameras of the scene.
void check_range_sensors(const scenes::Scene& scene);

}  // namespace earthshine::degrade
