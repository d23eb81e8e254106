// SPDX-License-Identifier: Apache-2.0
#include "app/console/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cctv/cctv.h"
#include "app/console/assets.h"
#include "app/console/pack.h"
#include "app/report/text.h"
#include "app/visibility/conditions.h"
#include "degrade/settings/presets.h"
#include "studies/sight/sight.h"

namespace earthshine::app {
namespace {

// All settings, including inactive ones, which the page's controls may activate.
Json all_settings(const degrade::CctvCamera& camera) {
  Json settings;
  degrade::visit_camera_fields(camera, [&](const char* name, const auto& value, auto&&...) {
    settings[name] = setting_json(value);
  });
  return settings;
}

Json model_json(const std::string& name, const degrade::CctvCamera& camera,
                const degrade::Monitor& monitor) {
  return {{"name", name}, {"camera", all_settings(camera)}, {"monitor", monitor_json(monitor)}};
}

Json presets_json() {
  Json presets = Json::array();
  for (const degrade::Preset& preset : degrade::presets()) {
    Json& entry =
        presets.emplace_back(model_json(std::string(preset.name), preset.camera, preset.monitor));
    entry["about"] = preset.about;
  }
  return presets;
}

Json places_json(const StudyPart& part) {
  Json places = Json::array();
  std::vector<ConditionEntry> conditions = conditions_of(part);
  conditions.resize(part.basis->places().size());  // of the first lamp setting
  for (const ConditionEntry& condition : conditions) {
    places.push_back({{"position_deg", to_json(condition.position_deg)},
                      {"time_s", to_json(condition.time_s)},
                      {"utc", condition.utc},
                      {"sun_share", to_json(condition.sun_share)},
                      {"phase", condition.phase}});
  }
  return places;
}

// The measures' constants, for the page's own verdicts.
Json sight_json(const studies::SightOptions& options) {
  return {{"eye_integration_s", options.eye_integration_s},
          {"frame_s", options.frame_s},
          {"even_chance_snr", options.even_chance_snr},
          {"seen_probability", options.seen_probability},
          {"doubtful_probability", options.doubtful_probability},
          {"hidden_fraction", options.hidden_fraction},
          {"most_black_back", options.most_black_back},
          {"cycles",
           {{"detect", options.cycles.detect},
            {"recognise", options.cycles.recognise},
            {"identify", options.cycles.identify}}},
          {"slope", options.eye.slope},
          {"threshold_factor", options.eye.threshold_factor}};
}

}  // namespace

ConsolePage::ConsolePage(const StudyPart& part, const std::vector<std::string>& set,
                         std::string layers_folder, const Common& common)
    : part_(part), common_(common) {
  Json lights = Json::array(), objects = Json::array();
  for (const ConsoleLight& light : console_lights(part)) {
    lights.push_back({{"name", light.name}, {"kind", light.kind}, {"group", light.group}});
  }
  for (const scenes::Object& object : part.loaded.scene.objects) objects.push_back(object.name);
  std::error_code ignored;
  const std::filesystem::path scene = std::filesystem::absolute(part.path, ignored);
  data_ = {
      {"format", 1},
      {"version", EARTHSHINE_VERSION},
      {"scene", part.loaded.scene.name.empty() ? scene.stem().string() : part.loaded.scene.name},
      {"path", scene.lexically_normal().string()},
      {"set", set},
      {"layers_folder", std::move(layers_folder)},
      {"lights", lights},
      {"places", places_json(part)},
      {"objects", objects},
      {"presets", presets_json()},
      {"sight", sight_json({})},
      {"study", nullptr},
      {"cameras", Json::array()}};
}

std::string ConsolePage::stored(const std::string& bytes) {
  if (bytes.empty()) return {};
  blobs_.push_back(base64(bytes));
  return fmt::format("b{}", blobs_.size() - 1);
}

Json ConsolePage::json_of(const studies::SightTarget& target) {
  const studies::TargetView& view = target.view;
  Json parts = Json::array();
  for (const studies::SightTarget::Part& part : target.parts) {
    parts.push_back({{"target", stored(pack_runs(part.target))},
                     {"surround", stored(pack_runs(part.surround))},
                     {"share", part.share}});
  }
  Json hidden_by = Json::array();
  for (const auto& blocker : view.hidden_by) hidden_by.push_back({blocker.object, blocker.pixels});
  return {{"name", view.name},
          {"object", view.object},
          {"hidden_by", hidden_by},
          {"pixels", view.pixels},
          {"alone", view.pixels_alone},
          {"in_frame", view.in_frame},
          {"black_back", view.black_back.size()},
          {"motion", view.motion_px_s},
          {"extent",
           {{"pixels", target.extent.pixels},
            {"direction_rad", target.extent.direction_rad},
            {"angle_deg", target.extent.angle_deg}}},
          {"measured", stored(pack_runs(view.measured))},
          {"surround", stored(pack_runs(view.surround))},
          {"parts", parts}};
}

void ConsolePage::add(const ConsoleView& view) {
  const scenes::Camera& camera = *view.camera->camera;
  Json layers = Json::array(), targets = Json::array();
  for (const ConsoleLayer& layer : view.layers) {
    const PackedLayer packed = pack_layer(layer.r, layer.g, layer.b, view.camera->columns);
    layers.push_back({{"light", layer.light},
                      {"place", to_json(layer.place)},
                      {"exponent", packed.exponent},
                      {"data", stored(packed.bytes)}});
  }
  for (const studies::SightTarget& target : view.plan.targets) targets.push_back(json_of(target));
  const CctvSetup cctv =
      view.camera->cctv ? *view.camera->cctv : cctv_of_camera(part_.loaded.scene, camera, common_);
  data_["cameras"].push_back(
      {{"name", camera.name},
       {"file", file_stem(part_.loaded.scene, camera)},
       {"columns", view.camera->columns},
       {"rows", view.camera->rows},
       {"fov_deg", camera.fov_deg},
       {"relative_noise", view.relative_noise},
       {"cctv", model_json(cctv.name, cctv.chain.camera, cctv.chain.monitor)},
       {"layers", layers},
       {"has_cctv", view.camera->cctv.has_value()},
       {"objects", stored(pack_objects(view.plan.map.object))},
       {"targets", targets}});
}

std::string page_of(const PageParts& parts, const Json& data,
                    const std::vector<std::string>& blobs) {
  // Nothing else may be loaded, and only the program's own script may run.
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src '{}';{} base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n{}",
      parts.script_hash, parts.connects ? " connect-src 'self';" : "", escaped(parts.title),
      parts.style, parts.body);
  page += fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", island(data));
  for (std::size_t k = 0; k < blobs.size(); ++k) {
    page += fmt::format("<script type=\"text/plain\" id=\"b{}\">{}</script>\n", k, blobs[k]);
  }
  page += fmt::format("<script>{}</script>\n</body>\n</html>\n", parts.script);
  return page;
}

std::string ConsolePage::html() const {
  return page_of(
      {data_["scene"].get<std::string>() + ": lighting console", std::string(console_style()),
       console_body(), console_script(), console_script_hash()},
      data_, blobs_);
}

}  // namespace earthshine::app
