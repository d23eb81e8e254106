// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/cctv.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "app/console.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/png_file.h"
#include "degrade/settings/presets.h"
#include "degrade/stage/read_setting.h"

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

Json monitor_json(const degrade::Monitor& monitor) {
  Json settings;
  degrade::visit_monitor_fields(monitor, [&](const char* name, const auto& value, auto&&...) {
    settings[name] = setting_json(value);
  });
  return settings;
}

Json settings_json(const degrade::CctvCamera& camera) {
  Json settings;
  degrade::visit_camera_fields(camera, [&](const char* name, const auto& value, auto&&...) {
    if (degrade::is_used(camera, name)) settings[name] = setting_json(value);
  });
  return settings;
}

CctvSetup cctv_of_camera(const scenes::Scene& scene, const scenes::Camera& camera,
                         const Common& common) {
  CctvSetup setup;
  setup.name = camera.cctv;
  if (setup.name.empty()) {
    setup.name = default_preset;
    if (!common.quiet) {
      note(fmt::format("note: camera \"{}\" names no CCTV camera, taking \"{}\"", camera.name,
                       setup.name));
    }
  }
  setup.chain.camera = degrade::resolve_camera(scene, setup.name);
  setup.chain.monitor = degrade::resolve_monitor(scene, setup.name);
  setup.chain.options.seed = common.seed;
  setup.chain.options.fov_deg = camera.fov_deg;
  setup.chain.options.view = static_cast<std::uint64_t>(&camera - scene.cameras.data());
  return setup;
}

CctvSetup cctv_of(const degrade::ResolvedCamera& camera, const Common& common) {
  CctvSetup setup{camera.name, {camera.camera, camera.monitor, {}}};
  setup.chain.options.seed = common.seed;
  return setup;
}

CctvSetup cctv_of_preset(const std::string& name, const Common& common) {
  if (const degrade::Preset* preset = degrade::find_preset(name)) {
    return cctv_of(degrade::resolve(*preset), common);
  }
  const std::vector<std::string> names = degrade::preset_names();
  throw base::Error(base::Blame::Input, "--preset", "there is no preset \"" + name + "\"",
                    fmt::format("the presets are {}", fmt::join(names, ", ")),
                    degrade::did_you_mean(name, names));
}

degrade::Result run_chain(const CctvSetup& setup, const base::Image& radiance) {
  return degrade::degrade(radiance, setup.chain.camera, setup.chain.monitor, setup.chain.options);
}

namespace {

HeaderTexts provenance(const CctvSetup& setup, const degrade::Result& result,
                       const HeaderTexts& more) {
  HeaderTexts texts = {{"Software", "earthshine " EARTHSHINE_VERSION},
                       {"earthshine:cctv", setup.name},
                       {"earthshine:seed", std::to_string(setup.chain.options.seed)},
                       {"earthshine:frame", std::to_string(setup.chain.options.frame)},
                       {"earthshine:cctv.report", cctv_json(setup, result).dump()}};
  texts.insert(texts.end(), more.begin(), more.end());
  return texts;
}

}  // namespace

void write_cctv(const std::string& path, const CctvSetup& setup, const degrade::Result& result,
                const HeaderTexts& more) {
  const HeaderTexts texts = provenance(setup, result, more);
  if (path.ends_with(".exr")) {
    base::write_exr(path, result.viewed, {texts, {}});
  } else {
    base::write_png(path, result.columns, result.rows, result.channels, result.pixels, texts);
  }
}

void write_twin(const std::string& path, const CctvSetup& setup, const degrade::Twin& twin,
                const degrade::Result& noisy, const HeaderTexts& more) {
  base::write_exr(path, degrade::to_image(twin, noisy), {provenance(setup, noisy, more), {}});
}

Json twin_json(const degrade::Twin& twin) {
  const auto mean = [](const degrade::Plane& values) {
    double sum = 0.0;
    for (float value : values) sum += static_cast<double>(value);
    return sum / static_cast<double>(values.size());
  };
  std::size_t likely = 0;
  for (float p : twin.detection.probability) likely += p >= 0.5F ? 1 : 0;
  return {{"median_snr", degrade::quantile(twin.snr, 0.5)},
          {"detectable_share",
           static_cast<double>(likely) / static_cast<double>(twin.detection.probability.size())},
          {"mean_detection_probability", mean(twin.detection.probability)},
          {"saturated_share", mean(twin.saturated)},
          {"crushed_share", mean(twin.crushed)}};
}

Json cctv_json(const CctvSetup& setup, const degrade::Result& result) {
  const degrade::Report& report = result.report;
  return {{"camera", setup.name},
          {"columns", result.columns},
          {"rows", result.rows},
          {"sensor", {report.sensor.columns, report.sensor.rows}},
          {"f_number", report.exposure.f_number},
          {"gain", report.exposure.gain},
          {"metered_cd_m2", report.exposure.metered},
          {"underexposed", report.exposure.underexposed},
          {"blown", report.exposure.blown},
          {"iris_moving", report.exposure.moving},
          {"noise", {{"a", report.noise.at_black()}, {"b", report.noise.b}, {"c", report.noise.c}}},
          {"saturated_share", report.levels.saturated_share},
          {"crushed_share", report.levels.crushed_share},
          {"excess_share", report.excess_share},
          {"lost_share", report.lost_share},
          {"negative_pixels", report.negative_pixels},
          {"clipped_negative_light", report.clipped_negative_light},
          {"stages", report.stages},
          {"frame", setup.chain.options.frame},
          {"seed", setup.chain.options.seed},
          {"settings", settings_json(setup.chain.camera)},
          {"monitor", monitor_json(setup.chain.monitor)}};
}

std::string cctv_summary(const CctvSetup& setup, const degrade::Result& result) {
  const degrade::Report& report = result.report;
  std::string text =
      fmt::format("{}: f/{:.3g}, gain {:.3g}, {:.1f} % at white, {:.1f} % lost in black",
                  setup.name, report.exposure.f_number, report.exposure.gain,
                  100.0 * report.levels.saturated_share, 100.0 * report.levels.crushed_share);
  if (report.exposure.moving) text += "; its iris is on the way";
  if (report.exposure.underexposed) text += "; too dark for it, wide open";
  if (report.exposure.blown) text += "; too bright for it, closed";
  if (report.negative_pixels > 0) {
    text += fmt::format("; {} negative pixels taken as black", report.negative_pixels);
  }
  return text;
}

StagePictures::StagePictures(std::string folder, const Files& inputs, degrade::Options& options)
    : folder_(std::move(folder)), options_(options) {
  if (folder_.empty()) return;
  prepare_folder(folder_, {}, {});
  refuse_inputs_in(folder_, inputs);
  options_.watch = [this, count = 0](const degrade::Stage& stage,
                                     const degrade::Picture& picture) mutable {
    base::write_exr(fmt::format("{}/{:02}-{}.exr", folder_, ++count, stage.name),
                    degrade::to_image(picture),
                    {{{"earthshine:cctv.stage", std::string(stage.name)}}, {}});
  };
}

StagePictures::~StagePictures() { options_.watch = {}; }

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
