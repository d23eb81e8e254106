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
#include "app/study/json_fields.h"
#include "app/study/results.h"
#include "app/study/study.h"
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

// What the tables have said from the beginning of one camera's target.
struct TableRow {
  std::string camera;
  studies::TargetMetrics target;
};

Json row_json(const TableRow& row, const ResultEntry& result) {
  const studies::TargetMetrics& target = row.target;
  const auto light = [&](auto member) -> Json {
    return target.light ? Json((*target.light).*member) : Json();
  };
  const auto optional_light = [&](auto member) -> Json {
    return target.light ? to_json((*target.light).*member) : Json();
  };
  const auto chance = [&](Figure of) { return to_json(of(result)); };
  return {{"camera", row.camera},
          {"target", target.view.name},
          {"pixels", target.view.pixels},
          {"pixels_alone", target.view.pixels_alone},
          {"visible_fraction", to_json(target.visible_fraction)},
          {"cut_by_frame", target.view.cut_by_frame},
          {"luminance_cd_m2", light(&studies::TargetLight::luminance)},
          {"surround_cd_m2", optional_light(&studies::TargetLight::surround)},
          {"contrast", optional_light(&studies::TargetLight::contrast)},
          {"saturated_share", to_json(target.saturated_share)},
          {"crushed_share", to_json(target.crushed_share)},
          {"verdict", std::string(word_of(result.sight.verdict))},
          {"detect", chance(chance_of<&studies::Probability::detect>)},
          {"recognise", chance(chance_of<&studies::Probability::recognise>)},
          {"identify", chance(chance_of<&studies::Probability::identify>)},
          {"lit_fraction", to_json(result.lit_fraction)},
          {"why", result.why}};
}

std::string cell(const Number& value, double factor, const char* unit) {
  return value ? fmt::format("{:.3g}{}", factor * *value, unit) : "-";
}

std::string table_of(const std::vector<TableRow>& rows) {
  std::string text =
      fmt::format("{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "camera", "target",
                  "pixels", "visible", "cd/m2", "surround", "contrast", "saturated", "crushed");
  for (const auto& [camera, target] : rows) {
    const auto& light = target.light;
    text += fmt::format(
        "{:<12} {:<24} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}\n", camera, target.view.name,
        fmt::format("{}{}", target.view.pixels, target.view.cut_by_frame ? "+" : ""),
        cell(target.visible_fraction, 100.0, " %"),
        cell(light ? Number(light->luminance) : Number(), 1.0, ""),
        cell(light ? light->surround : Number(), 1.0, ""),
        cell(light ? light->contrast : Number(), 1.0, ""),
        cell(target.saturated_share, 100.0, " %"), cell(target.crushed_share, 100.0, " %"));
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
      rows_.push_back({camera.name, target});
    }
  }

  [[nodiscard]] const std::vector<TableRow>& rows() const { return rows_; }

  [[nodiscard]] Json write(const StudyResults& study) {
    expose_alike(pictures_, tone_);
    Number solve_seconds = 0.0;
    for (const StudyCost& cost : study.costs) {
      if (cost.stage == "solve s0") solve_seconds = cost.seconds;
    }
    Json rows = Json::array(), answers = Json::array();
    for (const TableRow& row : rows_) rows.push_back(row_json(row, result_of(study, row)));
    for (const AnswerEntry& answer : study.answers) answers.push_back(kept_json(answer));
    Json json = {{"study", "visibility"},
                 {"version", EARTHSHINE_VERSION},
                 {"scene", call_.scene.path},
                 {"set", call_.scene.overrides},
                 {"seed", common_.seed},
                 {"patches", to_json(study.scenes[0].patches)},
                 {"solve_seconds", to_json(solve_seconds)},
                 {"cameras", views_},
                 {"targets", rows},
                 {"answers", answers}};
    base::write_text(std::filesystem::path(call_.folder) / results_csv, csv_of(rows));
    base::write_text(std::filesystem::path(call_.folder) / visibility_file, dump(json));
    return json;
  }

 private:
  // Of the study's one condition.
  static const ResultEntry& result_of(const StudyResults& study, const TableRow& row) {
    return *std::find_if(study.results.begin(), study.results.end(), [&](const ResultEntry& r) {
      return study.cameras[r.camera].name == row.camera &&
             study.targets[r.target] == row.target.view.name;
    });
  }

  const StudyCall& call_;
  const ToneChoice& tone_;
  const Common& common_;
  NamedPictures pictures_;
  Json views_ = Json::array();
  std::vector<TableRow> rows_;
};

void run(const VisibilityCall& call, const Common& common) {
  StudyTask task{study_of(call.study, call.wanted, call.iris), call.study.folder,
                 "study visibility", call.tone};
  task.part = call.study.part;
  if (call.dry_run) {
    const Json plan = plan_study(std::move(task), common);
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
  const std::optional<StudyResults> study = run_study(
      std::move(task), common,
      [&](const StudyPart& part, const StudyCamera& camera, const studies::BasisView& view,
          const StudyFrames::Frame& frame) { tables.add(part, camera, view, frame); });
  if (!study) return;  // a part
  const Json json = tables.write(*study);
  if (call.study.json) return print(dump(json));
  std::string text = table_of(tables.rows());
  for (const ResultEntry& result : study->results) {
    if (result.why.empty()) continue;
    text += fmt::format("{}, {}: {}\n", study->cameras[result.camera].name,
                        study->targets[result.target], result.why);
  }
  for (const AnswerEntry& answer : study->answers) {
    text += fmt::format("{}: {}\n", answer.wanted, answer.text);
  }
  for (const std::string& note : black_back_notes(*study)) text += note + "\n";
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
