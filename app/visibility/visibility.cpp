// SPDX-License-Identifier: Apache-2.0
// earthshine study visibility: how well each camera sees each target.
#include "studies/targets/visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/study/study.h"
#include "app/views/sight_json.h"
#include "app/visibility/pictures.h"
#include "app/visibility/run.h"
#include "base/files/output_file.h"

namespace earthshine::app {
namespace {

constexpr const char* results_csv = "visibility.csv";
constexpr const char* visibility_file = "visibility.json";

using Cameras = std::vector<const scenes::Camera*>;

struct VisibilityCall {
  StudyCall study;
  std::vector<std::string> wanted, iris;
  bool dry_run = false;
  ToneChoice tone = {usual_percent, {}};
};

std::string picture_name(const scenes::Scene& scene, const scenes::Camera& camera) {
  return "view-" + file_stem(scene, camera) + ".png";
}
std::string cctv_name(const scenes::Scene& scene, const scenes::Camera& camera) {
  return "cctv-" + file_stem(scene, camera) + ".png";
}

std::vector<std::string> file_names(const scenes::Scene& scene, const Cameras& cameras) {
  std::vector<std::string> names = {results_csv, visibility_file};
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
  return text +
         "Luminances of the clean picture, 0.2126 R + 0.7152 G + 0.0722 B.\n"
         "+ : reaches the picture's border, more of it may lie outside.\n";
}

// What the tables have said from the beginning, from the same picture as the rest of the study.
class Tables {
 public:
  Tables(const StudyCall& call, const ToneChoice& tone, const Common& common)
      : call_(call), tone_(tone), common_(common) {}

  void add(const StudyPart& part, const StudyCamera& looking, const studies::BasisView& view,
           const StudyFrames::Frame& frame) {
    const scenes::Scene& scene = part.loaded.scene;
    const scenes::Camera& camera = *looking.camera;
    const std::filesystem::path folder = call_.folder;
    base::Image image =
        studies::weighted_sum(view.layers, part.basis->groups().names, part.basis->weights(0, 0));
    image.channels.push_back(*view.layers.find("object"));
    pictures_.emplace_back(folder / picture_name(scene, camera), image);
    std::optional<studies::ClippedResels> clipped;
    Json cctv;
    if (looking.cctv) {
      const degrade::Setup& chain = looking.cctv->chain;
      const degrade::Result result = run_chain(*looking.cctv, image);
      write_cctv((folder / cctv_name(scene, camera)).string(), *looking.cctv, result);
      const studies::ShownRange shown =
          studies::shown_range(chain.camera, result.report, studies::mean_luminance(image));
      degrade::Twin twin = degrade::twin(image, chain.camera, chain.monitor, chain.options);
      clipped = {twin.signal.columns, twin.signal.rows, std::move(twin.saturated),
                 std::move(twin.crushed)};
      cctv = cctv_json(*looking.cctv, result);
      cctv["shown_from_cd_m2"] = shown.black;
      cctv["shown_to_cd_m2"] = shown.white;
    }
    views_.push_back({{"name", camera.name},
                      {"columns", image.width},
                      {"rows", image.height},
                      {"render_seconds", frame.seconds},
                      {"relative_noise", frame.relative_noise},
                      {"cctv", cctv}});
    for (const studies::TargetMetrics& target :
         studies::target_metrics(scene, camera, image, clipped)) {
      rows_.push_back(target_row(camera, target));
    }
  }

  // study: the content of study.json.
  [[nodiscard]] Json write(const Json& study) {
    expose_alike(pictures_, tone_);
    double solve_seconds = 0.0;
    for (const Json& cost : study["costs"]) {
      if (cost["stage"] == "solve s0") solve_seconds = cost["seconds"];
    }
    std::size_t k = 0;
    for (const Json& result : study["results"]) {
      Json& row = rows_[k++];
      row["verdict"] = result["verdict"];
      for (const char* task : {"detect", "recognise", "identify"}) {
        row[task] = result["probability"][task];
      }
      row["lit_fraction"] = result["lit_fraction"];
      row["why"] = result["why"];
    }
    const Json json = {{"study", "visibility"},
                       {"version", EARTHSHINE_VERSION},
                       {"scene", call_.scene.path},
                       {"set", call_.scene.overrides},
                       {"seed", common_.seed},
                       {"patches", study["scenes"][0]["patches"]},
                       {"solve_seconds", solve_seconds},
                       {"cameras", views_},
                       {"targets", rows_},
                       {"answers", study["answers"]}};
    base::write_text(std::filesystem::path(call_.folder) / results_csv, csv_of(rows_));
    base::write_text(std::filesystem::path(call_.folder) / visibility_file, dump(json));
    return json;
  }

 private:
  const StudyCall& call_;
  const ToneChoice& tone_;
  const Common& common_;
  NamedPictures pictures_;
  Json views_ = Json::array(), rows_ = Json::array();
};

void run(const VisibilityCall& call, const Common& common) {
  StudyTask task{study_of(call.study, call.wanted, call.iris), call.study.folder,
                 "study visibility", call.dry_run, call.tone};
  task.part = call.study.part;
  if (call.dry_run) {
    const Json plan = *run_study(std::move(task), common);
    return print(call.study.json ? dump(plan) : plan_text(plan));
  }
  const LoadedScene loaded = load(call.study.scene, true);
  Cameras cameras;
  for (const std::string& name : call.study.cameras) {
    const scenes::Camera* camera = &choose_camera(loaded.scene, name);
    if (std::find(cameras.begin(), cameras.end(), camera) == cameras.end()) {
      cameras.push_back(camera);
    }
  }
  for (const scenes::Camera& camera : loaded.scene.cameras) {
    if (call.study.cameras.empty()) cameras.push_back(&camera);
  }
  task.more_files = file_names(loaded.scene, cameras);
  Tables tables(call.study, call.tone, common);
  const std::optional<Json> study = run_study(
      std::move(task), common,
      [&](const StudyPart& part, const StudyCamera& camera, const studies::BasisView& view,
          const StudyFrames::Frame& frame) { tables.add(part, camera, view, frame); });
  if (!study) return;  // a part
  const Json json = tables.write(*study);
  if (call.study.json) return print(dump(json));
  std::string text = table_of(json["targets"]);
  for (const Json& row : json["targets"]) {
    if (row["why"].get<std::string>().empty()) continue;
    text += fmt::format("{}, {}: {}\n", row["camera"].get<std::string>(),
                        row["target"].get<std::string>(), row["why"].get<std::string>());
  }
  for (const Json& answer : json["answers"]) {
    text += fmt::format("{}: {}\n", answer["wanted"].get<std::string>(),
                        answer["text"].get<std::string>());
  }
  for (const std::string& note : black_back_notes((*study)["results"])) text += note + "\n";
  print(text);
}

}  // namespace

Command add_study_visibility(CLI::App& study) {
  CLI::App* parser =
      study.add_subcommand("visibility", "How well each camera sees each target of the scene");
  const auto call = std::make_shared<VisibilityCall>();
  add_study_options(*parser, call->study);
  add_cameras_option(*parser, call->study);
  add_wanted_options(*parser, call->wanted, call->iris);
  add_part_options(*parser, call->study.part);
  parser->add_flag("--dry-run", call->dry_run, "Only say what would be done, and its price");
  add_tone_options(*parser, call->tone, study_tone_help);
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
