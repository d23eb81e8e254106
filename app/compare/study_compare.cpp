// SPDX-License-Identifier: Apache-2.0
// earthshine study compare: radiosity, distributed lights and direct light in one view.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/compare/page.h"
#include "app/compare/tables.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/render/light.h"
#include "app/study/study.h"
#include "base/files/output_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "raytrace/light/distributed_area.h"
#include "raytrace/solve_control/wanted_error.h"
#include "scenes/effects/quality.h"
#include "scenes/view/motion.h"
#include "studies/compare/compare.h"
#include "studies/compare/target_differences.h"
#include "studies/cost/cost.h"
#include "studies/cost/memory.h"

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
  double time_limit_s = 0.0;
  bool dry_run = false;
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
          {"stopped_by_time_limit", comparison.stopped},
          {"noise_floor", comparison.reference_noise},
          {"errors_below_noise_floor", noisy},
          {"wide_sources", comparison.wide_sources},
          {"levels_out_at_lights", to_json(levels_out_at(comparison, false))},
          {"lights", lights_rows(comparison)},
          {"methods", method_rows(comparison)},
          {"targets", target_rows(comparison)},
          {"verdicts", verdicts}};
}

// Of two references, each of a solution with half the edge and a picture to half the error, and one
// picture of each other method.
raytrace::StageListener progress_of(const CompareCall& call, const Common& common,
                                    const scenes::Scene& scene,
                                    const studies::CompareOptions& options) {
  const auto progress = common.progress;
  const double triangles = static_cast<double>(scene.triangles.size());
  const double pixels = double(options.columns) * options.rows;
  const auto units = [=](const std::string& stage) {
    const bool reference = stage.starts_with(studies::reference_name);
    if (stage.ends_with("solution"))
      return std::pair(Work::Solve, (reference ? 4.0 : 1.0) * triangles);
    return std::pair(Work::Picture, (reference ? 2.0 : 1.0) * pixels);
  };
  const std::string reference = studies::reference_name;
  std::vector<std::string> stages = {reference + " solution", reference, reference + " solution",
                                     reference, "solution"};
  for (std::size_t k = 1; k < studies::compare_methods(call.lights, call.area).size(); ++k) {
    stages.emplace_back("picture");
  }
  for (const std::string& stage : stages) progress->expect(units(stage).first, units(stage).second);
  return [=](const std::string& stage) -> raytrace::Progress {
    const auto [work, amount] = units(stage);
    return progress->begin(stage, work, amount);
  };
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

// The program as users run it.
studies::CompareOptions options_of(const CompareCall& call, const scenes::Scene& scene,
                                   const scenes::Camera& camera, const Common& common) {
  studies::CompareOptions options;
  options.columns = call.size ? call.size->columns : camera.columns;
  options.rows = call.size ? call.size->rows : camera.rows;
  const raytrace::RenderOptions as_rendered =
      raytrace::render_options(scenes::resolve_quality(scene));
  options.gather_rays = as_rendered.gather_rays;
  options.camera_samples = as_rendered.camera_samples;
  options.distributed_lights = call.lights;
  options.distributed_over = call.area;
  options.error = scene.quality.error.value_or(0.0);
  options.solver = raytrace::picture_solver(scene, scene.quality, common.seed);
  options.seed = common.seed;
  options.time_limit_s = call.time_limit_s;
  return options;
}

// Seconds of the solves and of each method's pictures, from a pilot of all of them. The references'
// patches have half the edge: four times as many, each of the two.
Json plan_of(const CompareCall& call, const Common& common, const LoadedScene& loaded,
             const scenes::RayQuery& query, const scenes::Camera& camera,
             const studies::CompareOptions& options) {
  const std::vector<studies::Method> methods = studies::compare_methods(call.lights, call.area);
  std::vector<raytrace::RenderOptions> pictures = {
      studies::compare_picture(options, methods.front(), 1)};
  for (std::size_t k = 1; k < methods.size(); ++k) {
    pictures.push_back(studies::compare_picture(options, methods[k]));
  }
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, options.solver);
  studies::expect_rows(sizes, loaded.scene, query, options.solver);
  (void)common.progress->begin("pilot", Work::Pilot, static_cast<double>(pictures.size()));
  const studies::Pilot pilot =
      studies::expect_costs({loaded.world(query), options.solver, sizes.row_entries},
                            std::vector<const scenes::Camera*>(pictures.size(), &camera), pictures);
  double seconds = 0.0, drawn = 0.0;
  Json listed = Json::array();
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const double one = pilot.bill.pictures[k].seconds;
    const double all = k == 0 ? 2.0 * one : one;
    drawn += one;
    seconds += all;
    listed.push_back({{"method", methods[k].name}, {"seconds", all}});
  }
  const double solve = 9.0 * (studies::total_seconds(pilot.bill) - drawn);
  seconds += solve;
  const double limit = call.time_limit_s;
  return {{"study", "compare"},
          {"dry_run", true},
          {"scene", call.scene.path},
          {"camera", camera.name},
          {"columns", options.columns},
          {"rows", options.rows},
          {"error", options.error},
          {"solve_seconds", solve},
          {"methods", listed},
          {"seconds", limit > 0.0 ? std::max(solve, std::min(limit, seconds)) : seconds}};
}

std::string plan_text(const Json& plan) {
  std::string text = fmt::format("{}, camera {}: {} x {}\n", plan["scene"], plan["camera"],
                                 plan["columns"], plan["rows"]);
  text +=
      fmt::format("  {:<20} {:>12}\n", "solutions", duration(plan["solve_seconds"].get<double>()));
  for (const Json& method : plan["methods"]) {
    text += fmt::format("  {:<20} {:>12}\n", method["method"],
                        duration(method["seconds"].get<double>()));
  }
  return text + fmt::format("about {} on this machine\n", duration(plan["seconds"].get<double>()));
}

void run(const CompareCall& call, const Common& common) {
  LoadedScene loaded = load(call.scene, common.quiet);
  scenes::hold_still(loaded.scene);
  want_usual_error({}, loaded.scene);
  const scenes::Camera& camera = camera_of(call, loaded.scene, common.quiet);
  (void)raytrace::earth_area(loaded.scene, call.area);  // a wrong one is refused before the folder
  if (!call.dry_run) {
    prepare_folder(call.folder, file_names(call.lights, call.area), loaded.scene.files);
  }
  const bool marks = std::any_of(loaded.scene.objects.begin(), loaded.scene.objects.end(),
                                 [](const scenes::Object& object) { return object.target; });
  if (!marks && !common.quiet) {
    note(
        "note: the scene marks no object as a target: pictures are compared, and no verdict is "
        "given. Mark one with target = true");
  }
  const studies::CompareOptions options = options_of(call, loaded.scene, camera, common);
  const scenes::RayQuery query = ray_query(loaded, {{&camera}}, common.quiet, true);
  if (call.dry_run) {
    const Json plan = plan_of(call, common, loaded, query, camera, options);
    return print(call.json ? dump(plan) : plan_text(plan));
  }
  const studies::Comparison comparison = studies::compare(
      loaded.world(query), camera, options, progress_of(call, common, loaded.scene, options));

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
  if (comparison.stopped.empty()) return;
  throw StoppedShort(
      fmt::format("the time limit of {} ended these pictures before their wanted error: {}",
                  duration(call.time_limit_s), fmt::join(comparison.stopped, ", ")));
}

}  // namespace

Command add_study_compare(CLI::App& study) {
  CLI::App* parser = add_subcommand(
      study, "compare", "Radiosity against distributed lights and direct light, in one view");
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
          fmt::format("Number of lights per wide source (default {})",
                      fmt::join(call->lights, ",")))
      ->type_name("LIST");
  parser
      ->add_option("--distributed-over", call->area,
                   "Also with the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
  add_time_limit(*parser, call->time_limit_s,
                 "End pictures so that the whole takes about this long, or as long as the solves "
                 "take; results then differ between runs");
  parser->add_flag("--dry-run", call->dry_run, "Only print what would run and how long it takes");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
