// SPDX-License-Identifier: Apache-2.0
// earthshine study compare: radiosity, distributed lights and direct light in one view.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/compare/page.h"
#include "app/compare/tables.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/study/study.h"
#include "base/files/output_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "raytrace/light/distributed_area.h"
#include "raytrace/solve_control/wanted_error.h"
#include "scenes/effects/quality.h"
#include "studies/compare/compare.h"
#include "studies/compare/yardstick.h"

namespace earthshine::app {
namespace {

constexpr std::uint64_t most_lights = 1U << 16U;
constexpr const char* methods_csv = "compare.csv";
constexpr const char* targets_csv = "compare-targets.csv";
constexpr const char* lights_csv = "compare-lights.csv";
constexpr const char* compare_file = "compare.json";

struct CompareCall : StudyCall {
  std::vector<int> lights = studies::CompareOptions().distributed_lights;
  std::string area;
};

std::vector<std::string> file_names(const std::vector<int>& lights, const std::string& area) {
  std::vector<std::string> names = {methods_csv, targets_csv, lights_csv, compare_file,
                                    compare_page};
  for (const studies::Method& method : studies::compare_methods(lights, area)) {
    for (const std::string& file : picture_files(method)) names.push_back(file);
  }
  return names;
}

std::string word_of(studies::ApproximationVerdict verdict) {
  switch (verdict) {
    case studies::ApproximationVerdict::Misled:
      return "misled";
    case studies::ApproximationVerdict::NotMisled:
      return "not-misled";
    case studies::ApproximationVerdict::Undecided:
      return "undecided";
    case studies::ApproximationVerdict::NotInView:
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
  Json noisy = Json::array();
  for (const std::size_t k : studies::errors_below_the_references_noise(comparison)) {
    noisy.push_back(comparison.methods[k].method.name);
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
          {"camera_samples", options.camera_samples},
          {"reference_factor", options.reference_factor},
          {"patches", comparison.solution.patches},
          {"reference_patches", comparison.reference_patches},
          {"pixels_compared", comparison.reference().error.pixels},
          {"exposure",
           {{"signal_per_cd_m2", exposure.exposure}, {"white_cd_m2", exposure.white_cd_per_m2}}},
          {"rule",
           {{"luminance_factor", studies::misleading_factor},
            {"contrast_difference", studies::misleading_contrast}}},
          {"noise_floor", comparison.reference_noise},
          {"errors_below_noise_floor", noisy},
          {"wide_sources", comparison.wide_sources},
          {"levels_out_at_lights", to_json(levels_out_at(comparison, false))},
          {"lights", lights_rows(comparison)},
          {"methods", method_rows(comparison)},
          {"targets", target_rows(comparison)},
          {"verdicts", verdicts}};
}

void write_pictures(const std::filesystem::path& folder, const studies::Comparison& comparison,
                    const base::ToneReport& exposure) {
  const base::Image& right = comparison.reference().frame.image;
  const auto write = [&](const std::string& file, const std::vector<std::uint8_t>& rgb) {
    base::write_png(folder / file, right.width, right.height, 3, rgb);
  };
  for (const studies::MethodResult& result : comparison.methods) {
    const base::Image& image = result.frame.image;
    const std::vector<std::string> files = picture_files(result.method);
    write(files.front(), base::tone_map_with(image, exposure).rgb);
    if (files.size() > 1) {
      write(files.back(), studies::difference_picture(image, right, comparison.map));
    }
  }
}

void run(const CompareCall& call, const Common& common) {
  LoadedScene loaded = load(call.scene, common.quiet);
  const scenes::Camera& camera = camera_of(call, loaded.scene, common.quiet);
  (void)raytrace::earth_area(loaded.scene, call.area);  // reports errors before the folder is made
  prepare_folder(call.folder, file_names(call.lights, call.area), loaded.scene.files);

  studies::CompareOptions options;
  options.columns = call.size ? call.size->columns : camera.columns;
  options.rows = call.size ? call.size->rows : camera.rows;
  // With the settings of `render`.
  const raytrace::RenderOptions as_rendered =
      raytrace::render_options(scenes::resolve_quality(loaded.scene));
  options.gather_rays = as_rendered.gather_rays;
  options.camera_samples = as_rendered.camera_samples;
  options.distributed_lights = call.lights;
  options.distributed_over = call.area;
  options.error = loaded.scene.quality.error.value_or(0.0);
  options.solver = raytrace::picture_solver(loaded.scene, loaded.scene.quality, common.seed);
  options.seed = common.seed;
  const scenes::RayQuery query = ray_query(loaded, {{&camera}}, common.quiet, true);
  const studies::Comparison comparison =
      studies::compare(loaded.world(query), camera, options, progress_of_stages(common));

  const base::ToneReport exposure = base::tone_map(comparison.reference().frame.image).report;
  Json json = json_of(call, camera, options, comparison, exposure);
  json["warnings"] = loaded.scene.warnings;
  const std::filesystem::path folder = call.folder;
  write_pictures(folder, comparison, exposure);
  base::write_text(folder / methods_csv, csv_of(json["methods"]));
  base::write_text(folder / targets_csv, csv_of(json["targets"]));
  base::write_text(folder / lights_csv, csv_of(json["lights"]));
  base::write_text(folder / compare_file, dump(json));
  const std::string& name = loaded.scene.name;
  base::write_text(folder / compare_page, page_of(name.empty() ? call.scene.path : name,
                                                  camera.name, loaded.scene.warnings, comparison));
  print(call.json ? dump(json) : summary(comparison));
}

}  // namespace

Command add_study_compare(CLI::App& study) {
  CLI::App* parser = study.add_subcommand(
      "compare", "Radiosity against distributed lights and direct light, in one view");
  const auto call = std::make_shared<CompareCall>();
  add_study_options(*parser, *call);
  add_camera_option(*parser, *call);
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
