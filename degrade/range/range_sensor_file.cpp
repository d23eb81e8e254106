// SPDX-License-Identifier: Apache-2.0
#include "degrade/range/range_sensor_file.h"

#include <vector>

#include "degrade/stage/read_setting.h"

namespace earthshine::degrade {
namespace {

using base::Blame;
using base::Error;
using scenes::SettingTable;

RangeSensor read_sensor(const SettingTable& table) {
  RangeSensor sensor;
  const auto visit = [](RangeSensor& s, auto&& field) { visit_range_fields(s, field); };
  for (const scenes::Setting& setting : table.settings) {
    read_setting(setting, sensor, visit, {});
  }
  if (sensor.max_range_m > 0.0 && sensor.min_range_m >= sensor.max_range_m) {
    throw Error(Blame::Input, place_of(table, "min_range_m"),
                "min_range_m = " + number(sensor.min_range_m) +
                    " is not below max_range_m = " + number(sensor.max_range_m));
  }
  return sensor;
}

}  // namespace

RangeSensor resolve_range_sensor(const scenes::Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const SettingTable& table : scene.range_sensors) {
    if (table.name == name) return read_sensor(table);
    names.push_back(table.name);
  }
  throw Error(Blame::Input, scene.path.string(), "there is no range sensor " + in_quotes(name),
              names.empty() ? "the scene has no [[range_sensor]]" : "known are " + listed(names),
              did_you_mean(name, names));
}

void check_range_sensors(const scenes::Scene& scene) {
  for (const SettingTable& table : scene.range_sensors) static_cast<void>(read_sensor(table));
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.range_sensor.empty()) continue;
    static_cast<void>(resolve_range_sensor(scene, camera.range_sensor));
  }
}

}  // namespace earthshine::degrade
