// SPDX-License-Identifier: Apache-2.0
// earthshine study compare: radiosity, distributed lights and direct light in one view.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "app/console.h"
#include "app/study.h"
#include "base/output_file.h"
#include "base/png_file.h"
#include "base/tone.h"
#include "raytrace/camera_check.h"
#include "raytrace/distributed_area.h"
#include "scenes/quality.h"
#include "studies/compare.h"
#include "studies/difference_picture.h"

namespace earthshine::app {
namespace {

constexpr std::uint64_t most_lights = 1U << 16U;
constexpr const char* methods_csv = "compare.csv";
constexpr const char* targets_csv = "compare-targets.csv";
constexpr const char* results_json = "compare.json";

struct CompareCall : StudyCall {
  std::vector<int> lights = studies::CompareOptions().distributed_lights;
  std::string area;
};

std::string picture_name(const studies::Method& method) { return method.name + ".png"; }
// None for the reference, which would differ from itself by nothing.
std::optional<std::string> difference_name(const studies::Method& method) {
  if (method.name == studies::reference_name) return std::nullopt;
  return "difference-" + method.name + ".png";
}

std::vector<std::string> file_names(const std::vector<int>& lights, const std::string& area) {
  std::vector<std::string> names = {methods_csv, targets_csv, results_json};
  for (const studies::Method& method : studies::compare_methods(lights, area)) {
    names.push_back(picture_name(method));
    if (const auto difference = difference_name(method)) names.push_back(*difference);
  }
  return names;
}

Json method_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (const studies::MethodResult& result : comparison.methods) {
    const raytrace::RenderReport& report = result.frame.report;
    const int lights = result.method.distributed_lights;
    const std::string& over = result.method.distributed_over;
    rows.push_back({{"method", result.method.name},
                    {"lights", lights > 0 ? Json(lights) : Json()},
                    {"area", over.empty() ? Json() : Json(over)},
                    {"solve_seconds", result.solve_seconds},
                    {"render_seconds", result.render_seconds},
                    {"rays", report.rays.total()},
                    {"relative_rmse", result.difference.relative_rmse},
                    {"bias", result.difference.bias},
                    {"off_share", result.difference.off_share},
                    {"relative_noise", report.relative_noise}});
  }
  return rows;
}

Json target_rows(const studies::Comparison& comparison) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < comparison.targets.size(); ++k) {
    const studies::TargetView& view = comparison.targets[k];
    for (const studies::MethodResult& result : comparison.methods) {
      const auto& target = result.targets[k];
      Json row = {{"target", view.name}, {"method", result.method.name}, {"pixels", view.pixels}};
      row["luminance_cd_m2"] = target ? Json(target->light.luminance) : Json();
      row["surround_cd_m2"] = target ? to_json(target->light.surround) : Json();
      row["contrast"] = target ? to_json(target->light.contrast) : Json();
      row["luminance_ratio"] = target ? Json(target->luminance_ratio) : Json();
      row["contrast_difference"] = target ? to_json(target->contrast_difference) : Json();
      row["misleads"] = target ? Json(target->misleads) : Json();
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::string word_of(studies::Verdict verdict) {
  switch (verdict) {
    case studies::Verdict::Misled:
      return "misled";
    case studies::Verdict::NotMisled:
      return "not-misled";
    case studies::Verdict::Undecided:
      return "undecided";
    case studies::Verdict::NotInView:
      break;
  }
  return "not-in-view";
}

Json json_of(const CompareCall& call, const scenes::Camera& camera,
             const studies::CompareOptions& options, const studies::Comparison& comparison,
             const base::ToneReport& exposure) {
  Json verdicts = Json::array();
  const std::vector<studies::TargetVerdict> judged = studies::judge_approximation(comparison);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    verdicts.push_back({{"target", comparison.targets[k].name},
                        {"verdict", word_of(judged[k].verdict)},
                        {"sentence", judged[k].sentence}});
  }
  return {{"study", "compare"},
          {"version", EARTHSHINE_VERSION},
          {"scene", call.scene.path},
          {"set", call.scene.overrides},
          {"camera", camera.name},
          {"columns", options.columns},
          {"rows", options.rows},
          {"seed", options.seed},
          {"gather_rays", options.gather_rays},
          {"reference_gather_rays", options.gather_rays * options.reference_factor},
          {"patches", comparison.solution.patches},
          {"pixels_compared", comparison.reference().difference.pixels},
          {"exposure",
           {{"signal_per_cd_m2", exposure.exposure}, {"white_cd_m2", exposure.white_cd_per_m2}}},
          {"rule",
           {{"luminance_factor", studies::misleading_factor},
            {"contrast_difference", studies::misleading_contrast}}},
          {"methods", method_rows(comparison)},
          {"targets", target_rows(comparison)},
          {"verdicts", verdicts}};
}

void write_pictures(const std::filesystem::path& folder, const studies::Comparison& comparison,
                    const base::ToneReport& exposure) {
  const base::Image& reference = comparison.reference().frame.image;
  for (const studies::MethodResult& result : comparison.methods) {
    const base::Image& image = result.frame.image;
    base::write_png(folder / picture_name(result.method), image.width, image.height, 3,
                    base::tone_map_with(image, exposure).rgb);
    if (const auto name = difference_name(result.method)) {
      const studies::DifferencePicture difference = studies::difference_picture(image, reference);
      base::write_png(folder / *name, difference.columns, difference.rows, 3, difference.rgb);
    }
  }
}

std::string summary(const studies::Comparison& comparison) {
  std::string text = fmt::format("{:<18} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "method",
                                 "solve s", "render s", "rays", "RMSE", "bias", "off");
  for (const studies::MethodResult& result : comparison.methods) {
    const studies::PictureDifference& difference = result.difference;
    text += fmt::format("{:<18} {:>9.1f} {:>9.1f} {:>9} {:>7.1f} % {:>+7.1f} % {:>7.1f} %\n",
                        result.method.name, result.solve_seconds, result.render_seconds,
                        short_count(static_cast<double>(result.frame.report.rays.total())),
                        100.0 * difference.relative_rmse, 100.0 * difference.bias,
                        100.0 * difference.off_share);
  }
  text += fmt::format(
      "\nMisled: a target's luminance is off by more than a factor {}, or its contrast by more "
      "than "
      "{}.\n",
      studies::misleading_factor, studies::misleading_contrast);
  const std::vector<studies::TargetVerdict> verdicts = studies::judge_approximation(comparison);
  if (verdicts.empty()) text += "The scene marks no object as a target.\n";
  for (const studies::TargetVerdict& verdict : verdicts) text += verdict.sentence + "\n";
  return text;
}

void run(const CompareCall& call, const Common& common) {
  const LoadedScene loaded = load(call.scene, common.quiet);
  const std::string wanted = call.cameras.empty() ? "" : call.cameras.front();
  const scenes::Camera& camera = choose_camera(loaded.scene, wanted);
  if (call.cameras.empty() && loaded.scene.cameras.size() > 1 && !common.quiet) {
    note("note: no --camera, taking the first, \"" + camera.name + "\"");
  }
  (void)raytrace::earth_area(loaded.scene, call.area);  // a wrong one is refused before the folder
  prepare_folder(call.folder, file_names(call.lights, call.area));

  studies::CompareOptions options;
  options.columns = call.size ? call.size->columns : camera.columns;
  options.rows = call.size ? call.size->rows : camera.rows;
  // Every sample has gather rays of its own in all pictures: only the light differs between them.
  const scenes::QualityKnobs knobs = scenes::resolve_quality(loaded.scene);
  options.gather_rays =
      knobs.gather_rays *
      (loaded.scene.quality.gather_rays || !knobs.share_gather ? 1 : scenes::rays_alone_per_shared);
  options.distributed_lights = call.lights;
  options.distributed_over = call.area;
  options.solver = solve_options(loaded.scene, common);
  options.seed = common.seed;
  const scenes::RayQuery query(loaded.scene);
  raytrace::check_camera(loaded.scene, query, camera);
  const studies::Comparison comparison =
      studies::compare({loaded.scene, loaded.groups, loaded.effects, query}, camera, options,
                       progress_of_stages(common));

  const base::ToneReport exposure = base::tone_map(comparison.reference().frame.image).report;
  const Json json = json_of(call, camera, options, comparison, exposure);
  const std::filesystem::path folder = call.folder;
  write_pictures(folder, comparison, exposure);
  base::write_text(folder / methods_csv, csv_of(json["methods"]));
  base::write_text(folder / targets_csv, csv_of(json["targets"]));
  base::write_text(folder / results_json, dump(json));
  print(call.json ? dump(json) : summary(comparison));
}

}  // namespace

Command add_study_compare(CLI::App& study) {
  CLI::App* parser = study.add_subcommand(
      "compare", "Radiosity against distributed lights and direct light, in one view");
  const auto call = std::make_shared<CompareCall>();
  add_study_options(*parser, *call);
  parser->add_option("--camera", call->cameras, "Camera of the scene (default: its first)")
      ->type_name("NAME")
      ->expected(1)
      ->allow_extra_args(false);
  parser
      ->add_option_function<std::string>(
          "--lights",
          [call](const std::string& text) {
            call->lights.clear();
            for (const std::string& word : split_at_commas(text)) {
              call->lights.push_back(static_cast<int>(
                  read_whole_number("--lights", word, studies::fewest_lights, most_lights)));
            }
          },
          fmt::format("How many lights stand for a wide source (default {})",
                      fmt::join(call->lights, ",")))
      ->type_name("LIST");
  parser
      ->add_option("--distributed-over", call->area,
                   "Also with the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
