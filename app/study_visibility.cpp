// SPDX-License-Identifier: Apache-2.0
// earthshine study visibility: how well each camera sees each target.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cctv.h"
#include "app/console.h"
#include "app/study.h"
#include "base/output_file.h"
#include "base/png_file.h"
#include "base/tone.h"
#include "raytrace/camera_check.h"
#include "scenes/quality.h"
#include "studies/visibility.h"

namespace earthshine::app {
namespace {

constexpr const char* results_csv = "visibility.csv";
constexpr const char* results_json = "visibility.json";

using Cameras = std::vector<const scenes::Camera*>;

// Those asked for, each once, in the order of the call; all of the scene where none is.
Cameras choose_cameras(const scenes::Scene& scene, const std::vector<std::string>& names) {
  Cameras cameras;
  const auto add = [&](const scenes::Camera& camera) {
    if (std::find(cameras.begin(), cameras.end(), &camera) == cameras.end()) {
      cameras.push_back(&camera);
    }
  };
  for (const std::string& name : names) add(choose_camera(scene, name));
  if (!names.empty()) return cameras;
  (void)choose_camera(scene, {});  // refuses a scene without any
  for (const scenes::Camera& camera : scene.cameras) add(camera);
  return cameras;
}

std::string picture_name(const scenes::Scene& scene, const scenes::Camera& camera) {
  return "view-" + file_stem(scene, camera) + ".png";
}
std::string cctv_name(const scenes::Scene& scene, const scenes::Camera& camera) {
  return "cctv-" + file_stem(scene, camera) + ".png";
}

std::vector<std::string> file_names(const scenes::Scene& scene, const Cameras& cameras) {
  std::vector<std::string> names = {results_csv, results_json};
  for (const scenes::Camera* camera : cameras) {
    names.push_back(picture_name(scene, *camera));
    if (!camera->cctv.empty()) names.push_back(cctv_name(scene, *camera));
  }
  return names;
}

Json target_row(const scenes::Camera& camera, const studies::TargetMetrics& target) {
  const auto light = [&](auto member) -> Json {
    return target.light ? Json((*target.light).*member) : Json();
  };
  const auto optional_light = [&](auto member) -> Json {
    return target.light ? to_json((*target.light).*member) : Json();
  };
  return {{"camera", camera.name},
          {"target", target.view.name},
          {"pixels", target.view.pixels},
          {"pixels_alone", target.view.pixels_alone},
          {"visible_fraction", to_json(target.visible_fraction)},
          {"cut_by_frame", target.view.cut_by_frame},
          {"luminance_cd_m2", light(&studies::TargetLight::luminance)},
          {"surround_cd_m2", optional_light(&studies::TargetLight::surround)},
          {"contrast", optional_light(&studies::TargetLight::contrast)},
          {"saturated_share", to_json(target.saturated_share)},
          {"crushed_share", to_json(target.crushed_share)}};
}

Json camera_json(const scenes::Camera& camera, const studies::View& view,
                 const std::optional<CctvSetup>& cctv) {
  Json json = {{"name", camera.name},
               {"columns", view.frame.image.width},
               {"rows", view.frame.image.height},
               {"render_seconds", view.frame.report.seconds},
               {"relative_noise", view.frame.report.relative_noise},
               {"cctv", Json()}};
  if (cctv) {
    json["cctv"] = cctv_json(*cctv, *view.cctv);
    json["cctv"]["shown_from_cd_m2"] = view.shown->black;
    json["cctv"]["shown_to_cd_m2"] = view.shown->white;
  }
  return json;
}

std::string cell(const Json& value, double factor, const char* unit) {
  return value.is_null() ? "-" : fmt::format("{:.3g}{}", factor * value.get<double>(), unit);
}

std::string table_of(const Json& rows) {
  std::string text =
      fmt::format("{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "camera", "target",
                  "pixels", "visible", "cd/m2", "surround", "contrast", "saturated", "crushed");
  for (const Json& row : rows) {
    text += fmt::format(
        "{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n",
        row["camera"].get<std::string>(), row["target"].get<std::string>(),
        fmt::format("{}{}", row["pixels"].get<std::size_t>(), row["cut_by_frame"] ? "+" : ""),
        cell(row["visible_fraction"], 100.0, " %"), cell(row["luminance_cd_m2"], 1.0, ""),
        cell(row["surround_cd_m2"], 1.0, ""), cell(row["contrast"], 1.0, ""),
        cell(row["saturated_share"], 100.0, " %"), cell(row["crushed_share"], 100.0, " %"));
  }
  if (rows.empty()) return "The scene marks no object as a target.\n";
  return text + "+ : reaches the picture's border, more of it may lie outside.\n";
}

void run(const StudyCall& call, const Common& common) {
  const LoadedScene loaded = load(call.scene, common.quiet);
  const scenes::Scene& scene = loaded.scene;
  const Cameras cameras = choose_cameras(scene, call.cameras);
  prepare_folder(call.folder, file_names(scene, cameras));
  const std::filesystem::path folder = call.folder;

  const scenes::RayQuery query(scene);
  for (const scenes::Camera* camera : cameras) raytrace::check_camera(scene, query, *camera);
  StageTimes times;
  const radiosity::Solution solution = times.measure("solve", [&] {
    return radiosity::solve(scene, loaded.groups, loaded.effects, query,
                            solve_options(scene, common));
  });
  Json views = Json::array(), rows = Json::array();
  for (const scenes::Camera* camera : cameras) {
    std::optional<CctvSetup> cctv;
    if (!camera->cctv.empty()) cctv = cctv_of_camera(scene, *camera, common);
    studies::ViewOptions options;
    options.columns = call.size ? call.size->columns : camera->columns;
    options.rows = call.size ? call.size->rows : camera->rows;
    const raytrace::RenderOptions render = raytrace::render_options(scenes::resolve_quality(scene));
    options.gather_rays = render.gather_rays;
    options.shared = render.shared;
    options.seed = common.seed;
    if (cctv) options.cctv = cctv->chain;
    const studies::View view =
        studies::look({scene, loaded.groups, loaded.effects, query}, solution, *camera, options,
                      progress_of_stages(common)("camera " + camera->name));
    const base::Image& image = view.frame.image;
    base::write_png(folder / picture_name(scene, *camera), image.width, image.height, 3,
                    base::tone_map(image).rgb);
    if (cctv) write_cctv((folder / cctv_name(scene, *camera)).string(), *cctv, *view.cctv);
    views.push_back(camera_json(*camera, view, cctv));
    for (const studies::TargetMetrics& target : view.targets) {
      rows.push_back(target_row(*camera, target));
    }
  }
  const Json json = {{"study", "visibility"},
                     {"version", EARTHSHINE_VERSION},
                     {"scene", call.scene.path},
                     {"set", call.scene.overrides},
                     {"seed", common.seed},
                     {"patches", solution.report.patches},
                     {"solve_seconds", times.total()},
                     {"cameras", views},
                     {"targets", rows}};
  base::write_text(folder / results_csv, csv_of(rows));
  base::write_text(folder / results_json, dump(json));
  print(call.json ? dump(json) : table_of(rows));
}

}  // namespace

Command add_study_visibility(CLI::App& study) {
  CLI::App* parser =
      study.add_subcommand("visibility", "How well each camera sees each target of the scene");
  const auto call = std::make_shared<StudyCall>();
  add_study_options(*parser, *call);
  parser->add_option("--camera", call->cameras, "Camera (may be repeated; default: all)")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
