// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/cctv_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/cctv/cctv.h"
#include "degrade/settings/camera_file.h"

namespace earthshine::app {
namespace {

// The settings that decide whether a stage runs, a line per stage; without any each picture goes
// through it.
struct Deciding {
  std::string_view stage;
  std::vector<std::string_view> settings;
};
const std::vector<Deciding>& deciding() {
  static const std::vector<Deciding> table = {
      {"sensor-grid", {}},
      {"iris", {}},
      {"lens", {}},
      {"fall-off", {"fall_off"}},
      {"glare", {"glare"}},
      {"lens-spread", {"lens_blur"}},
      {"conversion", {}},
      {"shading", {"shading_percent"}},
      {"signal-noise", {"noise"}},
      {"lag", {"lag"}},
      {"blur", {"blur_h", "blur_v"}},
      {"smear", {"smear_db"}},
      {"bloom", {"saturation", "bloom"}},
      {"saturation", {"saturation"}},
      {"read-noise", {"noise"}},
      {"bandwidth", {"bandwidth_mhz", "aperture_correction"}},
      {"black-clamp", {"black_clamp"}},
      {"gain", {"iris", "gain_db", "gain_max_db"}},
      {"levels", {}},
      {"white-clip", {"white_clip"}},
      {"camera-gamma", {"gamma"}},
      {"quantisation", {"bits"}},
      {"interlace", {"interlace"}},
      {"screen", {}},
      {"spread", {"monitor.spread", "monitor.pixels_per_resel"}},
      {"room-light", {"monitor.room_illuminance", "monitor.reflectance"}}};
  return table;
}

template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return std::string(degrade::word_of(value));
  } else {
    return fmt::format("{}", value);
  }
}

std::map<std::string, std::string, std::less<>> settings_of(const degrade::CctvCamera& camera,
                                                            const degrade::Monitor& monitor) {
  std::map<std::string, std::string, std::less<>> settings;
  degrade::visit_camera_fields(camera, [&](const char* name, const auto& value, auto&&...) {
    settings[name] = text_of(value);
  });
  degrade::visit_monitor_fields(monitor, [&](const char* name, const auto& value, auto&&...) {
    settings[std::string("monitor.") + name] = text_of(value);
  });
  return settings;
}

}  // namespace

Json plan_cctv(const scenes::Scene& scene, const scenes::Camera& camera, bool asked) {
  Json rows = Json::array();
  if (camera.cctv.empty() && !asked) return rows;
  const std::string model = camera.cctv.empty() ? std::string(default_preset) : camera.cctv;
  const degrade::CctvCamera settings = degrade::resolve_camera(scene, model);
  const degrade::Monitor monitor = degrade::resolve_monitor(scene, model);
  const auto values = settings_of(settings, monitor);
  for (const degrade::StagePlan& planned : degrade::plan(settings, monitor)) {
    const std::string_view name = planned.stage->name;
    const auto row = std::find_if(deciding().begin(), deciding().end(),
                                  [&](const Deciding& line) { return line.stage == name; });
    // A new stage must say what turns it on.
    if (row == deciding().end()) {
      throw base::Error(base::Blame::Work, "plan",
                        fmt::format("no settings are known that decide about stage \"{}\"", name));
    }
    std::vector<std::string> why;
    for (const std::string_view setting : row->settings) {
      why.push_back(fmt::format("{} is {}", setting, values.at(std::string(setting))));
    }
    rows.push_back({{"stage", planned.stage->name},
                    {"runs", planned.runs},
                    {"why", why.empty() ? "part of every CCTV picture"
                                        : fmt::format("{}", fmt::join(why, ", "))}});
  }
  return rows;
}

}  // namespace earthshine::app
