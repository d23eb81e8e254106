// SPDX-License-Identifier: Apache-2.0
// earthshine plan: which effects will run and why, how many rays and how much memory that is.
// Traces nothing but a few rows of form factors, for the memory.
#include <fmt/format.h>

#include <bit>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/memory.h"
#include "degrade/camera_file.h"
#include "degrade/chain.h"
#include "radiosity/refine.h"
#include "scenes/quality.h"

namespace earthshine::app {
namespace {

struct PlanCall {
  SceneInput scene;
  bool json = false;
};

Json effects_of(const LoadedScene& loaded) {
  Json rows = Json::array();
  for (const auto& row : scenes::describe_effects(loaded.scene, loaded.groups)) {
    rows.push_back({{"effect", row.effect}, {"runs", row.runs}, {"why", row.reason}});
  }
  return rows;
}

Json cctv_stages(const scenes::Scene& scene, const scenes::Camera& camera) {
  Json names = Json::array();
  if (camera.cctv.empty()) return names;
  for (const degrade::StagePlan& planned :
       degrade::plan(degrade::resolve_camera(scene, camera.cctv),
                     degrade::resolve_monitor(scene, camera.cctv))) {
    if (planned.runs) names.push_back(planned.stage->name);
  }
  return names;
}

Json images_of(const scenes::Scene& scene, std::uint64_t gather_rays) {
  Json images = Json::array();
  for (const scenes::Camera& camera : scene.cameras) {
    const auto pixels =
        static_cast<std::uint64_t>(camera.columns) * static_cast<std::uint64_t>(camera.rows);
    images.push_back({{"camera", camera.name},
                      {"resolution", {camera.columns, camera.rows}},
                      {"gather_rays", pixels * gather_rays},
                      {"cctv_stages", cctv_stages(scene, camera)}});
  }
  return images;
}

// Of the solution alone, and of each camera's picture of its own size, the solution included.
void add_memory(Json& report, const LoadedScene& loaded) {
  const radiosity::SolveOptions solver = solve_options(loaded.scene, {});
  const scenes::RayQuery query(loaded.scene);
  studies::MemoryCase sizes =
      studies::memory_case(loaded.scene, loaded.groups, loaded.effects, solver);
  studies::expect_rows(sizes, loaded.scene, query, solver);
  report["memory"] = memory_json(studies::memory_needed(sizes));
  for (std::size_t k = 0; k < loaded.scene.cameras.size(); ++k) {
    raytrace::RenderOptions picture =
        raytrace::render_options(scenes::resolve_quality(loaded.scene));
    picture.columns = loaded.scene.cameras[k].columns;
    picture.rows = loaded.scene.cameras[k].rows;
    studies::MemoryCase with_picture = sizes;
    studies::add_picture(with_picture, loaded.groups, loaded.effects, picture);
    report["images"][k]["memory"] = memory_json(studies::memory_needed(with_picture));
  }
}

Json report_of(const LoadedScene& loaded) {
  const scenes::QualityKnobs knobs = scenes::resolve_quality(loaded.scene);
  const auto rays_per_patch = std::bit_ceil(static_cast<std::uint64_t>(knobs.form_factor_rays));
  const bool lit = loaded.groups.count() > 0;
  const bool refines = knobs.refine && radiosity::is_lit(loaded.effects);
  const std::size_t patches =
      refines ? radiosity::most_refined_patches(loaded.scene, solve_options(loaded.scene, {}))
              : radiosity::count_patches(loaded.scene, knobs.patch_edge_m);
  const bool solves = lit && loaded.effects.interreflection;
  Json report;
  report["scene"] = loaded.scene.path.string();
  report["name"] = loaded.scene.name;
  report["effects"] = effects_of(loaded);
  report["light_groups"] = loaded.groups.names;
  report["quality"] = {{"patch_edge_m", knobs.patch_edge_m},
                       {"refine", knobs.refine},
                       {"form_factor_rays", rays_per_patch},
                       {"gather_rays", knobs.gather_rays},
                       {"solver_tolerance", knobs.solver_tolerance}};
  report["patches"] = patches;
  report["patches_at_most"] = refines;
  report["rays"] = solves ? patches * rays_per_patch : 0;
  report["right_hand_sides"] = 3 * loaded.groups.count();
  report["images"] =
      images_of(loaded.scene, solves ? static_cast<std::uint64_t>(knobs.gather_rays) : 0);
  add_memory(report, loaded);
  return report;
}

std::string text_of(const Json& report) {
  std::string text = fmt::format("{} ({})\n\n", report["name"].get<std::string>(),
                                 report["scene"].get<std::string>());
  for (const Json& row : report["effects"]) {
    text += fmt::format("  {:<4} {:<18} {}\n", row["runs"].get<bool>() ? "yes" : "no",
                        row["effect"].get<std::string>(), row["why"].get<std::string>());
  }
  const Json& quality = report["quality"];
  const bool refines = report["patches_at_most"].get<bool>();
  text += fmt::format(
      "\n{}{} patches {}; {} form-factor rays ({} per patch)\n", refines ? "at most " : "",
      report["patches"].get<std::size_t>(),
      refines ? std::string("where light varies")
              : fmt::format("with edges up to {:g} m", quality["patch_edge_m"].get<double>()),
      short_count(report["rays"].get<double>()), quality["form_factor_rays"].get<int>());
  text += fmt::format("{} right-hand sides, solved to {:g}\n",
                      report["right_hand_sides"].get<std::size_t>(),
                      quality["solver_tolerance"].get<double>());
  text += std::string("memory of the solution: ") + (refines ? "at most " : "") +
          memory_text(report["memory"]) + "\n";
  for (const Json& image : report["images"]) {
    text += fmt::format("camera {}: {} x {} pixels, {} gather rays, {:.0f} MiB in all\n",
                        image["camera"].get<std::string>(), image["resolution"][0].get<int>(),
                        image["resolution"][1].get<int>(),
                        short_count(image["gather_rays"].get<double>()),
                        image["memory"]["total_mib"].get<double>());
    const auto stages = image["cctv_stages"].get<std::vector<std::string>>();
    if (!stages.empty()) text += fmt::format("  cctv: {}\n", fmt::join(stages, ", "));
  }
  return text;
}

}  // namespace

Command add_plan(CLI::App& program) {
  CLI::App* parser = program.add_subcommand(
      "plan", "Which effects will run, which not and why, and how many rays");
  const auto call = std::make_shared<PlanCall>();
  add_scene_options(*parser, call->scene);
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common& common) {
            const Json report = report_of(load(call->scene, common.quiet));
            print(call->json ? dump(report) : text_of(report));
          }};
}

}  // namespace earthshine::app
