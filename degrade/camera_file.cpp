// SPDX-License-Identifier: Apache-2.0
#include "degrade/camera_file.h"

#include <cmath>
#include <locale>
#include <sstream>
#include <type_traits>
#include <vector>

#include "degrade/presets.h"

namespace earthshine::degrade {
namespace {

using base::Blame;
using base::Error;
using scenes::Setting;
using scenes::SettingTable;

std::string in_quotes(std::string_view word) { return "\"" + std::string(word) + "\""; }

std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

// "a, b or c".
template <class Words>
std::string listed(const Words& words) {
  std::string text;
  std::size_t left = std::size(words);
  for (const auto& word : words) {
    text += in_quotes(word);
    if (--left > 0) text += left == 1 ? " or " : ", ";
  }
  return text;
}

template <class Words>
std::string did_you_mean(std::string_view word, const Words& words) {
  const std::string nearest = base::nearest_word(word, words);
  return nearest.empty() ? std::string() : "Did you mean " + in_quotes(nearest) + "?";
}

template <class T>
T value_of(const Setting& setting) {
  if (const T* value = std::get_if<T>(&setting.value)) return *value;
  const char* const wanted = std::is_same_v<T, bool>     ? "true or false"
                             : std::is_same_v<T, double> ? "a number"
                                                         : "a word in quotes";
  throw Error(Blame::Input, setting.where,
              in_quotes(setting.key) + " has a value of the wrong kind",
              std::string("it must be ") + wanted);
}

void read_value(const Setting& setting, bool& field, Limits) { field = value_of<bool>(setting); }

void read_value(const Setting& setting, double& field, Limits limits) {
  const double value = value_of<double>(setting);
  if (!(value >= limits.least && value <= limits.most)) {
    throw Error(Blame::Input, setting.where, in_quotes(setting.key) + " is " + number(value),
                "it must lie between " + number(limits.least) + " and " + number(limits.most));
  }
  field = value;
}

void read_value(const Setting& setting, int& field, Limits limits) {
  double value = 0.0;
  read_value(setting, value, limits);
  if (value != std::floor(value)) {
    throw Error(Blame::Input, setting.where, in_quotes(setting.key) + " is " + number(value),
                "it must be a whole number");
  }
  field = static_cast<int>(value);
}

template <class E>
requires std::is_enum_v<E>
void read_value(const Setting& setting, E& field, Limits) {
  const std::string word = value_of<std::string>(setting);
  const auto words = words_of(E{});
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) {
      field = static_cast<E>(i);
      return;
    }
  }
  throw Error(Blame::Input, setting.where, in_quotes(setting.key) + " is " + in_quotes(word),
              "it must be " + listed(words), did_you_mean(word, words));
}

// Puts one setting into the field of its name; `visit` walks the fields of `target`.
template <class Target, class Visit>
void read_setting(const Setting& setting, Target& target, Visit visit,
                  std::vector<std::string> other_keys) {
  bool known = false;
  visit(target, [&](const char* key, auto& field, Limits limits, const char*, const char*) {
    other_keys.emplace_back(key);
    if (setting.key != key) return;
    known = true;
    read_value(setting, field, limits);
  });
  if (known) return;
  throw Error(Blame::Input, setting.where, "unknown key " + in_quotes(setting.key), {},
              did_you_mean(setting.key, other_keys));
}

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

const base::Location& place_of(const SettingTable& table, std::string_view key) {
  for (const Setting& setting : table.settings) {
    if (setting.key == key) return setting.where;
  }
  return table.where;
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
