// SPDX-License-Identifier: Apache-2.0
#include "degrade/settings/camera_file.h"

#include "degrade/stage/read_setting.h"

namespace earthshine::degrade {
namespace {

// Smaller bandwidths blur each point over more than a quarter of a line.
constexpr double least_bandwidth_mhz = 0.01;

using base::Blame;
using base::Error;
using scenes::Setting;
using scenes::SettingTable;

const Setting* find_setting(const SettingTable& table, std::string_view key) {
  for (const Setting& setting : table.settings) {
    if (setting.key == key) return &setting;
  }
  return nullptr;
}

// The preset that `preset = "..."` names; nullptr without this key.
const Preset* named_preset(const SettingTable& table) {
  const Setting* const setting = find_setting(table, "preset");
  if (setting == nullptr) return nullptr;
  const std::string name = value_of<std::string>(*setting);
  if (const Preset* preset = find_preset(name)) return preset;
  throw Error(Blame::Input, setting->where, "there is no preset " + in_quotes(name),
              "it must be " + listed(preset_names()), did_you_mean(name, preset_names()));
}

const Preset* starting_point(const SettingTable& table) {
  const Preset* const named = named_preset(table);
  return named != nullptr ? named : find_preset(table.name);
}

// Value of `noise` for which a setting has an effect, or "".
std::string_view form_of(std::string_view key) {
  if (key == "snr_db") return "\"report\" or \"spec\"";
  for (const NoiseMode mode : {NoiseMode::Photon, NoiseMode::Law}) {
    CctvCamera with, without;
    with.noise = mode;
    if (is_used(with, key) && !is_used(without, key)) {
      return mode == NoiseMode::Law ? "\"law\"" : "\"photon\"";
    }
  }
  return {};
}

// Condition under which a setting has an effect.
std::string company_of(std::string_view key) {
  if (const std::string_view form = form_of(key); !form.empty()) {
    return "noise = " + std::string(form);
  }
  if (key == "bloom") return "saturation above 0";
  if (key == "bloom_radius") return "saturation and bloom above 0";
  if (key == "f_number" || key == "gain_db") return "iris = \"fixed\"";
  return key == "iris_centre" ? "iris = \"normal\"" : "an iris that is not \"fixed\"";
}

void check_one_form_of_noise(const SettingTable& table) {
  const Setting* first = nullptr;
  for (const Setting& setting : table.settings) {
    const std::string_view form = form_of(setting.key);
    if (form.empty()) continue;
    if (first == nullptr) first = &setting;
    if (form_of(first->key) == form) continue;
    throw Error(Blame::Input, setting.where,
                in_quotes(setting.key) + " stands beside " + in_quotes(first->key) +
                    ": that gives the noise in two forms",
                in_quotes(first->key) + " goes with noise = " + std::string(form_of(first->key)) +
                    ", " + in_quotes(setting.key) + " with noise = " + std::string(form),
                "Leave one out; earthshine degrade --describe prints the other forms");
  }
}

void check_used(const SettingTable& table, const CctvCamera& camera) {
  for (const Setting& setting : table.settings) {
    if (setting.key == "preset" || is_used(camera, setting.key)) continue;
    throw Error(Blame::Input, setting.where,
                in_quotes(setting.key) +
                    " has no effect with iris = " + in_quotes(word_of(camera.iris)) +
                    ", noise = " + in_quotes(word_of(camera.noise)) +
                    " and saturation = " + number(camera.saturation),
                "it goes with " + company_of(setting.key), "Leave it out, or set that");
  }
}

CctvCamera read_camera(const SettingTable& table) {
  const Preset* const start = starting_point(table);
  CctvCamera camera = start != nullptr ? start->camera : CctvCamera{};
  const auto visit = [](CctvCamera& c, auto&& field) { visit_camera_fields(c, field); };
  for (const Setting& setting : table.settings) {
    if (setting.key == "preset") continue;
    read_setting(setting, "[[cctv]]", camera, visit, {"preset", "name"});
  }
  // Checked last, because a later key may set the iris or the noise.
  check_one_form_of_noise(table);
  check_used(table, camera);
  if (camera.f_number_min > camera.f_number_max) {
    throw Error(Blame::Input, place_of(table, "f_number_min"),
                "f_number_min = " + number(camera.f_number_min) +
                    " is above f_number_max = " + number(camera.f_number_max));
  }
  if (camera.bandwidth_mhz > 0.0 && camera.bandwidth_mhz < least_bandwidth_mhz) {
    throw Error(Blame::Input, place_of(table, "bandwidth_mhz"),
                "bandwidth_mhz = " + number(camera.bandwidth_mhz) + " leaves one grey of a line",
                "it must be 0 (any), or from " + number(least_bandwidth_mhz) + " on");
  }
  return camera;
}

const SettingTable* find_table(const scenes::Scene& scene, std::string_view name) {
  for (const SettingTable& table : scene.cctv) {
    if (table.name == name) return &table;
  }
  return nullptr;
}

// The preset whose monitor is used if the scene has none.
const Preset* preset_behind(const scenes::Scene& scene, const std::string& name) {
  const SettingTable* const table = find_table(scene, name);
  return table != nullptr ? starting_point(*table) : find_preset(name);
}

Monitor read_monitor(const SettingTable& table) {
  const Preset* const start = named_preset(table);
  Monitor monitor = start != nullptr ? start->monitor : Monitor{};
  const auto visit = [](Monitor& m, auto&& field) { visit_monitor_fields(m, field); };
  for (const Setting& setting : table.settings) {
    if (setting.key != "preset") read_setting(setting, "[monitor]", monitor, visit, {"preset"});
  }
  for (const Setting& setting : table.settings) {
    if (is_used(monitor, setting.key)) continue;
    throw Error(Blame::Input, setting.where,
                in_quotes(setting.key) +
                    " has no effect with spread = " + in_quotes(word_of(monitor.spread)),
                {}, "Leave it out or choose a spread");
  }
  if (monitor.black_luminance >= monitor.white_luminance) {
    throw Error(Blame::Input, place_of(table, "black_luminance"),
                "black_luminance = " + number(monitor.black_luminance) +
                    " is not below white_luminance = " + number(monitor.white_luminance));
  }
  return monitor;
}

// Source of each key in use: its position in the table, else the preset's source, else "default".
class SourceList {
 public:
  SourceList(const SettingTable* table, const std::vector<SettingSource>* preset)
      : table_(table), preset_(preset) {}

  void add(std::string_view key) { list_.push_back({std::string(key), source_of(key)}); }
  [[nodiscard]] std::vector<SettingSource> take() { return std::move(list_); }

 private:
  [[nodiscard]] std::string source_of(std::string_view key) const {
    const Setting* const setting = table_ != nullptr ? find_setting(*table_, key) : nullptr;
    if (setting != nullptr) return base::to_string(setting->where);
    if (preset_ != nullptr) {
      for (const SettingSource& known : *preset_) {
        if (known.key == key) return known.source;
      }
    }
    return "default";
  }

  const SettingTable* table_;
  const std::vector<SettingSource>* preset_;
  std::vector<SettingSource> list_;
};

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

CctvCamera resolve_camera(const scenes::Scene& scene, const std::string& name,
                          const std::string& of, const std::optional<base::Location>& named_at) {
  if (const SettingTable* table = find_table(scene, name)) return read_camera(*table);
  if (const Preset* preset = find_preset(name)) return preset->camera;
  std::vector<std::string> names = preset_names();
  for (const SettingTable& table : scene.cctv) names.push_back(table.name);
  throw Error(Blame::Input, named_at.value_or(base::Location{scene.path.string()}),
              (of.empty() ? "" : of + ": ") + "there is no CCTV camera " + in_quotes(name),
              "known are " + listed(names), did_you_mean(name, names));
}

Monitor resolve_monitor(const scenes::Scene& scene, const std::string& name) {
  if (scene.monitor) return read_monitor(*scene.monitor);
  const Preset* const preset = preset_behind(scene, name);
  return preset != nullptr ? preset->monitor : Monitor{};
}

ResolvedCamera resolve(const scenes::Scene& scene, const std::string& name) {
  ResolvedCamera result;
  result.name = name;
  result.camera = resolve_camera(scene, name);
  result.monitor = resolve_monitor(scene, name);
  const SettingTable* const table = find_table(scene, name);
  const Preset* const preset = preset_behind(scene, name);
  if (preset != nullptr) {
    result.about = table == nullptr ? std::string(preset->about)
                                    : "starts from " + std::string(preset->name) + ": " +
                                          std::string(preset->about);
  }
  SourceList camera(table, preset != nullptr ? &preset->sources : nullptr);
  visit_camera_fields(result.camera, [&](const char* key, const auto&, auto&&...) {
    if (is_used(result.camera, key)) camera.add(key);
  });
  result.sources = camera.take();

  const SettingTable* const screen = scene.monitor ? &*scene.monitor : nullptr;
  const Preset* const start = screen != nullptr ? named_preset(*screen) : preset;
  SourceList monitor(screen, start != nullptr ? &start->monitor_sources : nullptr);
  visit_monitor_fields(result.monitor, [&](const char* key, const auto&, auto&&...) {
    if (is_used(result.monitor, key)) monitor.add(key);
  });
  result.monitor_sources = monitor.take();
  return result;
}

ResolvedCamera resolve(const Preset& preset) {
  return {std::string(preset.name), std::string(preset.about), preset.camera, preset.sources,
          preset.monitor,           preset.monitor_sources};
}

void check_settings(const scenes::Scene& scene) {
  for (const SettingTable& table : scene.cctv) static_cast<void>(read_camera(table));
  if (scene.monitor) static_cast<void>(read_monitor(*scene.monitor));
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.cctv.empty()) continue;
    static_cast<void>(
        resolve_camera(scene, camera.cctv, "camera " + in_quotes(camera.name), camera.cctv_at));
  }
}

}  // namespace earthshine::degrade
