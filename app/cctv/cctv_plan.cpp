// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/cctv_plan.h"

#include <fmt/format.h>

#include <map>

#include "app/cctv/cctv.h"
#include "degrade/settings/camera_file.h"

namespace earthshine::app {
namespace {

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
    std::vector<std::string> why;
    for (const std::string_view setting : planned.stage->settings) {
      if (setting.empty()) break;
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
