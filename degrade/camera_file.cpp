// SPDX-License-Identifier: Apache-2.0
#include "degrade/camera_file.h"

#include <vector>

#include "degrade/presets.h"
#include "degrade/read_setting.h"

namespace earthshine::degrade {
namespace {

using base::Blame;
using base::Error;
using scenes::Setting;
using scenes::SettingTable;

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

CctvCamera starting_point(const SettingTable& table) {
  for (const Setting& setting : table.settings) {
    if (setting.key != "preset") continue;
    const std::string name = value_of<std::string>(setting);
    if (const Preset* preset = find_preset(name)) return preset->camera;
    throw Error(Blame::Input, setting.where, "there is no preset " + in_quotes(name),
                "it must be " + listed(preset_names()), did_you_mean(name, preset_names()));
  }
  const Preset* const same_name = find_preset(table.name);
  return same_name != nullptr ? same_name->camera : CctvCamera{};
}

CctvCamera read_camera(const SettingTable& table) {
  CctvCamera camera = starting_point(table);
  const auto visit = [](CctvCamera& c, auto&& field) { visit_camera_fields(c, field); };
  for (const Setting& setting : table.settings) {
    if (setting.key == "preset" || setting.key == "name") continue;
    read_setting(setting, camera, visit, {"preset", "name"});
  }
  // Only now, because a later key may say which iris or noise it is.
  for (const Setting& setting : table.settings) {
    if (is_used(camera, setting.key)) continue;
    throw Error(Blame::Input, setting.where,
                in_quotes(setting.key) +
                    " has no effect with iris = " + in_quotes(word_of(camera.iris)) +
                    " and noise = " + in_quotes(word_of(camera.noise)),
                {}, "Leave it out or choose another iris or noise");
  }
  if (camera.f_number_min > camera.f_number_max) {
    throw Error(Blame::Input, place_of(table, "f_number_min"),
                "f_number_min = " + number(camera.f_number_min) +
                    " is above f_number_max = " + number(camera.f_number_max));
  }
  return camera;
}

const SettingTable* find_table(const scenes::Scene& scene, std::string_view name) {
  for (const SettingTable& table : scene.cctv) {
    if (table.name == name) return &table;
  }
  return nullptr;
}

}  // namespace

CctvCamera resolve_camera(const scenes::Scene& scene, const std::string& name) {
  if (const SettingTable* table = find_table(scene, name)) return read_camera(*table);
  if (const Preset* preset = find_preset(name)) return preset->camera;
  std::vector<std::string> names = preset_names();
  for (const SettingTable& table : scene.cctv) names.push_back(table.name);
  throw Error(Blame::Input, scene.path.string(), "there is no CCTV camera " + in_quotes(name),
              "known are " + listed(names), did_you_mean(name, names));
}

Monitor resolve_monitor(const scenes::Scene& scene) {
  Monitor monitor;
  if (!scene.monitor) return monitor;
  const SettingTable& table = *scene.monitor;
  const auto visit = [](Monitor& m, auto&& field) { visit_monitor_fields(m, field); };
  for (const Setting& setting : table.settings) read_setting(setting, monitor, visit, {});
  if (monitor.spread == Spread::None) {
    for (const Setting& setting : table.settings) {
      if (setting.key != "spread_width") continue;
      throw Error(Blame::Input, setting.where,
                  "\"spread_width\" has no effect with spread = \"none\"", {},
                  "Leave it out or choose a spread");
    }
  }
  if (monitor.black_luminance >= monitor.white_luminance) {
    throw Error(Blame::Input, place_of(table, "black_luminance"),
                "black_luminance = " + number(monitor.black_luminance) +
                    " is not below white_luminance = " + number(monitor.white_luminance));
  }
  return monitor;
}

void check_settings(const scenes::Scene& scene) {
  for (const SettingTable& table : scene.cctv) static_cast<void>(read_camera(table));
  static_cast<void>(resolve_monitor(scene));
  for (const scenes::Camera& camera : scene.cameras) {
    if (!camera.cctv.empty()) static_cast<void>(resolve_camera(scene, camera.cctv));
  }
}

}  // namespace earthshine::degrade
