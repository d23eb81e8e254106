// SPDX-License-Identifier: Apache-2.0
// earthshine study compare: radiosity, distributed lights and direct light in one view.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "app/compare/tables.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/study/study.h"
#include "base/files/output_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "raytrace/camera/check.h"
#include "raytrace/light/distributed_area.h"
#include "scenes/effects/quality.h"
#include "studies/compare/compare.h"
#include "studies/compare/difference_picture.h"

namespace earthshine::app {
namespace {

constexpr std::uint64_t most_lights = 1U << 16U;
constexpr const char* methods_csv = "compare.csv";
constexpr const char* targets_csv = "compare-targets.csv";
constexpr const char* equal_targets_csv = "compare-equal-targets.csv";
constexpr const char* curves_csv = "compare-curves.csv";
constexpr const char* lights_csv = "compare-lights.csv";
constexpr const char* compare_file = "compare.json";
constexpr const char* equal_time = "equal-time-";
constexpr const char* equal_error = "equal-error-";

struct CompareCall : StudyCall {
  std::vector<int> lights = studies::CompareOptions().distributed_lights;
  std::string area;
  std::optional<double> seconds, error;
};

// Of the reference its picture alone: it would differ from itself by nothing.
std::vector<std::string> file_names(const std::vector<int>& lights, const std::string& area) {
  std::vector<std::string> names = {methods_csv, targets_csv, equal_targets_csv,
                                    curves_csv,  lights_csv,  compare_file};
  for (const studies::Method& method : studies::compare_methods(lights, area)) {
    const bool is_reference = method.name == studies::reference_name;
    for (const char* basis : {"", equal_time, equal_error}) {
      if (is_reference && *basis != 0) continue;
      names.push_back(basis + method.name + ".png");
      if (!is_reference) names.push_back(std::string("difference-") + basis + method.name + ".png");
    }
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
  return {{"study", "compare"},
          {"version", EARTHSHINE_VERSION},
          {"scene", call.scene.path},
          {"set", call.scene.overrides},
          {"camera", camera.name},
          {"columns", options.columns},
          {"rows", options.rows},
          {"seed", options.seed},
          {"gather_rays", options.gather_rays},
          {"reference_gather_rays", options.rays_of_a_reference()},
          {"patches", comparison.solution.patches},
          {"reference_patches", comparison.reference_patches},
          {"pixels_compared", comparison.reference().difference.pixels},
          {"exposure",
           {{"signal_per_cd_m2", exposure.exposure}, {"white_cd_m2", exposure.white_cd_per_m2}}},
          {"rule",
           {{"luminance_factor", studies::misleading_factor},
            {"contrast_difference", studies::misleading_contrast}}},
          {"noise_floor", comparison.reference_noise.relative_rmse},
          {"wide_sources", comparison.wide_sources},
          {"levels_out_at_lights", to_json(levels_out_at(comparison, false))},
          {"equal",
           {{"cpu_seconds", comparison.equal_seconds},
            {"relative_rmse", comparison.equal_error},
            {"targets", equal_target_rows(comparison)}}},
          {"curves", curve_rows(comparison)},
          {"lights", lights_rows(comparison)},
          {"methods", method_rows(comparison)},
          {"targets", target_rows(comparison)},
          {"verdicts", verdicts}};
}

class Pictures {
 public:
  Pictures(std::filesystem::path folder, const studies::Comparison& comparison,
           const base::ToneReport& exposure)
      : folder_(std::move(folder)), comparison_(comparison), exposure_(exposure) {}

  void write() const {
    for (const studies::MethodResult& result : comparison_.methods) {
      const std::string& name = result.method.name;
      if (name == studies::reference_name) {
        write_one(name, result.frame.image);
        continue;
      }
      write_pair("", name, result.frame.image, result.difference, "At the scene's settings.");
      if (!result.equal) continue;
      const studies::EqualResult& equal = *result.equal;
      const std::string given = fmt::format("given {:.3g} CPU s", comparison_.equal_seconds);
      // A method that takes longer even at its least has no picture at equal time.
      if (equal.at_time) {
        write_pair(equal_time, name, equal.at_time->image, equal.at_time->difference,
                   fmt::format("At equal time: {}, took {:.3g}.", given, equal.at_time->seconds));
      } else {
        remove_pair(equal_time, name);
      }
      const bool reached = equal.ladder.end == studies::LadderEnd::Reached;
      write_pair(equal_error, name, equal.at_error.image, equal.at_error.difference,
                 fmt::format("{} of {:.3g} %: {:.3g} CPU s.",
                             reached ? "At the equal error"
                                     : "The least error; it does not reach the equal error",
                             100.0 * comparison_.equal_error, equal.at_error.seconds));
    }
  }

 private:
  void write_one(const std::string& name, const base::Image& image) const {
    base::write_png(folder_ / (name + ".png"), image.width, image.height, 3,
                    base::tone_map_with(image, exposure_).rgb);
  }
  void write_pair(const std::string& basis, const std::string& name, const base::Image& image,
                  const studies::PictureDifference& difference, const std::string& when) const {
    write_one(basis + name, image);
    const std::vector<std::string> caption = {
        name +
            " / reference: ratio of the luminances in cd/m2. Red: too bright, blue: too dark, "
            "white: within x1.1, or black in both. Grey: sky, not compared.",
        when,
        fmt::format("RMSE {:.3g} %, bias {:+.3g} % of the mean luminance; off by more than x{}: "
                    "{:.3g} % of the pixels.",
                    100.0 * difference.relative_rmse, 100.0 * difference.bias,
                    studies::misleading_factor, 100.0 * difference.off_share)};
    const studies::DifferencePicture picture = studies::difference_picture(
        image, comparison_.reference().frame.image, comparison_.map, caption);
    base::write_png(folder_ / ("difference-" + basis + name + ".png"), picture.columns,
                    picture.rows, 3, picture.rgb);
  }
  // Of an earlier run into the same folder.
  void remove_pair(const std::string& basis, const std::string& name) const {
    std::error_code none;
    std::filesystem::remove(folder_ / (basis + name + ".png"), none);
    std::filesystem::remove(folder_ / ("difference-" + basis + name + ".png"), none);
  }

  std::filesystem::path folder_;
  const studies::Comparison& comparison_;
  const base::ToneReport& exposure_;
};

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
  // The program as users run it; the references alone share no gather rays.
  const scenes::QualityKnobs knobs = scenes::resolve_quality(loaded.scene);
  const raytrace::RenderOptions as_rendered = raytrace::render_options(knobs);
  options.gather_rays = as_rendered.gather_rays;
  options.shared = as_rendered.shared;
  options.reference_rays =
      options.reference_factor * knobs.gather_rays *
      (loaded.scene.quality.gather_rays || !knobs.share_gather ? 1 : scenes::rays_alone_per_shared);
  options.equal = studies::EqualOptions{call.seconds, call.error};
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
  Pictures(folder, comparison, exposure).write();
  base::write_text(folder / methods_csv, csv_of(json["methods"]));
  base::write_text(folder / targets_csv, csv_of(json["targets"]));
  base::write_text(folder / equal_targets_csv, csv_of(json["equal"]["targets"]));
  base::write_text(folder / curves_csv, csv_of(json["curves"]));
  base::write_text(folder / lights_csv, csv_of(json["lights"]));
  base::write_text(folder / compare_file, dump(json));
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
  add_number(*parser, "--seconds", call->seconds, 1e-3, 1e7,
             "Equal time: CPU seconds for each method (default: what radiosity takes)");
  add_number(*parser, "--equal-error", call->error, 1e-6, 10.0,
             "Equal error, relative (default: what radiosity reaches in the equal time)");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
