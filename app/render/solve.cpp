// SPDX-License-Identifier: Apache-2.0
// earthshine solve: radiosity only, with its energy ledger.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "app/call/memory.h"
#include "app/command.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/render/error_json.h"
#include "app/render/light.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "radiosity/solution.h"
#include "raytrace/solve_control/reach_surfaces.h"
#include "scenes/effects/quality.h"
#include "scenes/ray_query.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {
namespace {

struct SolveCall {
  SceneInput scene;
  std::string output, mesh, solution;
  double time_limit_s = 0.0;
  bool json = false;
};

Json groups_of(const radiosity::SolveReport& report) {
  Json groups = Json::array();
  for (const radiosity::GroupLedger& group : report.groups) {
    groups.push_back({{"name", group.name},
                      {"given_lm", to_json(group.given_lm)},
                      {"escaped_at_once_lm", to_json(group.escaped_at_once_lm)},
                      {"lost_at_once_lm", to_json(group.lost_at_once_lm)},
                      {"emitted_lm", to_json(group.emitted_lm)},
                      {"landed_lm", to_json(group.landed_lm)},
                      {"absorbed_lm", to_json(group.absorbed_lm)},
                      {"escaped_lm", to_json(group.escaped_lm)},
                      {"imbalance", group.imbalance}});
  }
  return groups;
}

Json objects_of(const radiosity::SolveReport& report) {
  Json objects = Json::array();
  for (const radiosity::ObjectLight& object : report.objects) {
    objects.push_back({{"name", object.name},
                       {"area_m2", object.area_m2},
                       {"illuminance_lx", to_json(object.illuminance_lx)},
                       {"radiosity_lm_m2", to_json(object.radiosity_lm_m2)},
                       {"back_share", object.back_share}});
  }
  return objects;
}

Json sources_of(const radiosity::SolveReport& report, const scenes::LightGroups& groups) {
  Json sources = Json::array();
  for (const radiosity::SourceFlux& source : report.sources) {
    const bool named = source.group < groups.names.size();
    sources.push_back({{"name", source.name},
                       {"group", named ? Json(groups.names[source.group]) : Json()},
                       {"emitted_lm", to_json(source.emitted_lm)},
                       {"landed_lm", to_json(source.landed_lm)},
                       {"escaped_share", source.escaped_share},
                       {"black_share", source.back_share},
                       {"share_std_error", source.share_std_error},
                       {"scale", source.scale}});
  }
  return sources;
}

Json refinement_of(const radiosity::SolveReport& report) {
  Json rounds = Json::array();
  for (const radiosity::RefineRound& round : report.rounds) {
    rounds.push_back({{"patches", round.patches}, {"error", round.error}});
  }
  return {{"rounds", rounds}, {"rays", report.refinement_rays}};
}

}  // namespace

Json solve_json(const LoadedScene& loaded, const radiosity::SolveReport& report,
                const StageTimes& times) {
  Json json;
  json["scene"] = loaded.scene.path.string();
  json["patches"] = report.patches;
  json["refinement"] = refinement_of(report);
  json["rays"] = report.form_factor_rays;
  json["shadow_rays"] = report.shadow_rays;
  json["nonzeros"] = report.nonzeros;
  json["seconds"] = times.json();
  json["iterations"] = report.iterations;
  json["residual"] = report.residual;
  json["solver_error"] = report.solver_error;
  json["back_share"] = report.back_share;
  json["balance"] = {{"sweeps", report.balance.sweeps},    {"before", report.balance.before},
                     {"after", report.balance.after},      {"borrowed", report.balance.borrowed},
                     {"filled", report.balance.filled},    {"held", report.balance.held},
                     {"balanced", report.balance.balanced}};
  json["groups"] = groups_of(report);
  json["sources"] = sources_of(report, loaded.groups);
  json["objects"] = objects_of(report);
  json["warnings"] = loaded.scene.warnings;
  return json;
}

namespace {

double luminous(const Json& rgb) {
  return base::luminance({rgb[0].get<double>(), rgb[1].get<double>(), rgb[2].get<double>()});
}

// Energy from source to sink. Columns without values are omitted.
std::string ledger_text(const Json& groups) {
  constexpr std::array<std::array<const char*, 2>, 7> all = {{{"given_lm", "given lm"},
                                                              {"escaped_at_once_lm", "out at once"},
                                                              {"lost_at_once_lm", "black backs"},
                                                              {"emitted_lm", "emitted lm"},
                                                              {"landed_lm", "landed lm"},
                                                              {"absorbed_lm", "absorbed lm"},
                                                              {"escaped_lm", "escaped lm"}}};
  if (groups.empty()) return "\nlight group\nnone: nothing gives light\n";
  std::string head = fmt::format("\n{:<20}", "light group");
  std::vector<std::string> lines;
  for (const Json& group : groups) {
    lines.push_back(fmt::format("{:<20}", group["name"]));
  }
  for (const auto& [key, title] : all) {
    const auto shown = [&, name = key](const Json& group) {
      const double lm = luminous(group[name]);
      return std::abs(lm) <= 1e-9 * luminous(group["given_lm"]) ? 0.0 : lm;
    };
    if (std::none_of(groups.begin(), groups.end(), shown)) continue;
    head += fmt::format(" {:>12}", title);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      lines[k] += fmt::format(" {:>12.6g}", shown(groups[k]));
    }
  }
  std::string text = head + fmt::format(" {:>10}\n", "imbalance");
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += lines[k] + fmt::format(" {:>10.2g}\n", groups[k]["imbalance"]);
  }
  return text;
}

std::string solve_text(const Json& json) {
  std::string text = fmt::format(
      "{} patches, {} form-factor rays, {} shadow rays\n{} iterations, solved to {:.2g}; column "
      "defect {:.2g}, balanced to {:.2g} in {} sweeps\n",
      json["patches"], short_count(json["rays"].get<double>()),
      short_count(json["shadow_rays"].get<double>()), json["iterations"], json["solver_error"],
      json["balance"]["before"], json["balance"]["after"], json["balance"]["sweeps"]);
  const Json& rounds = json["refinement"]["rounds"];
  if (!rounds.empty()) {
    text += fmt::format("refined in {} rounds from {} patches, {} rays; estimated error {:.2g}\n",
                        rounds.size() - 1, rounds.front()["patches"].get<std::size_t>(),
                        short_count(json["refinement"]["rays"].get<double>()),
                        rounds.back()["error"].get<double>());
  }
  text += ledger_text(json["groups"]);
  text +=
      "\nAll by luminance, 0.2126 R + 0.7152 G + 0.0722 B; by channel: --json\n"
      "Of objects, means over what no body covers\n";
  text += fmt::format("{:<24} {:>12} {:>14} {:>16}\n", "object", "area m2", "illuminance lx",
                      "radiosity lm/m2");
  for (const Json& o : json["objects"]) {
    text += fmt::format("{:<24} {:>12.6g} {:>14.6g} {:>16.6g}\n", o["name"], o["area_m2"],
                        luminous(o["illuminance_lx"]), luminous(o["radiosity_lm_m2"]));
  }
  text += "\n";
  for (const auto& [stage, seconds] : json["seconds"].items()) {
    text += fmt::format("{:<20} {:>10}\n", stage, duration(seconds.get<double>()));
  }
  return text;
}

bool is_json(const std::string& path) { return path.ends_with(".json"); }

void check_call(const SolveCall& call) {
  if (call.output.ends_with(".glb")) {
    throw base::Error(base::Blame::Input, "-o", fmt::format("\"{}\" is a GLB file", call.output),
                      {}, "Name it after --glb");
  }
  if (!call.mesh.empty() && !call.mesh.ends_with(".glb") && !call.mesh.starts_with("/dev/")) {
    throw base::Error(base::Blame::Input, "--glb",
                      fmt::format("\"{}\" is not a .glb file", call.mesh), {},
                      "Name a file that ends in .glb");
  }
}

}  // namespace

Solved solve_alone(const ExactCall& call, const std::string& file, StageTimes& times) {
  const LoadedScene& loaded = call.loaded;
  const radiosity::SolveOptions options = solve_options(loaded.scene, call.common);
  const bool steered = file.empty() && loaded.scene.quality.error;
  check_memory(loaded, call.query,
               steered ? raytrace::first_surface_options(loaded.scene, *loaded.scene.quality.error,
                                                         call.common.seed)
                       : options,
               nullptr, file.empty());
  if (steered) return solve_as_exactly(call, times);
  Solved light;
  light.solver = options;
  light.solution = solve_or_read(loaded, call.query, options, file, call.common, times);
  light.solved = true;
  (void)call.common.progress->begin("error of the solution", Work::Solve,
                                    static_cast<double>(loaded.scene.triangles.size()));
  light.surface = times.measure("error", [&] {
    return raytrace::surface_error(loaded.world(call.query), light.solution, options);
  });
  const std::optional<double> error = loaded.scene.quality.error;
  if (!error) return light;
  const radiosity::SolveReport& report = light.solution.report;
  const double found = light.surface.parts.total().estimate;
  light.steps.push_back({"solve", report.patches, report.rays_per_patch, 0, *error, found});
  if (light.surface.known && found > *error) light.limit = raytrace::Limit::Given;
  return light;
}

namespace {

void run(const SolveCall& call, const Common& common) {
  check_call(call);
  StageTimes times;
  LoadedScene loaded = times.measure("read", [&] { return load(call.scene, common.quiet); });
  Files inputs = loaded.scene.files;
  inputs.emplace_back(call.solution);
  check_outputs({call.output, call.mesh}, inputs);
  refuse_other_kind("-o", call.output, {".h5", ".json"});
  const scenes::RayQuery query =
      times.measure("build", [&] { return ray_query(loaded, {}, common.quiet); });
  const radiosity::SolveOptions options = solve_options(loaded.scene, common);
  const std::optional<double> error = loaded.scene.quality.error;
  const bool steers = error && call.solution.empty();
  if (call.time_limit_s > 0.0 && !steers && !common.quiet) {
    note(std::string("note: --time-limit has no effect: ") +
         (call.solution.empty() ? "no error is asked for" : "--solution is used unchanged"));
  }
  const Solved light =
      solve_alone({loaded, common, query, call.time_limit_s}, call.solution, times);
  const radiosity::Solution& solution = light.solution;
  if (!common.quiet) {
    note_backs(solution.report);
    note_lost_flux(solution.report);
  }
  const bool writes_report = is_json(call.output);
  if (!call.output.empty() && !writes_report) {
    times.measure("write", [&] { write_solution(call.output, solution, loaded, options); });
  }
  if (!call.mesh.empty()) {
    times.measure("write GLB", [&] { write_mesh(call.mesh, solution, loaded); });
  }
  Json json = solve_json(loaded, solution.report, times);
  const double price = seconds_to_go(light, error, times.total());
  json["error"] = error_json(light, error);
  json["error"]["seconds_to_go"] = price > 0.0 ? Json(price) : Json();
  if (writes_report) base::write_text(call.output, dump(json));
  if (call.json) print(dump(json));
  if (!call.json && !writes_report) {
    std::string text = solve_text(json) + "\n" + error_text(light, error);
    if (price > 0.0) {
      text += fmt::format("\n  {} needs about {} more, or more", scenes::percent(*error),
                          duration(price));
    }
    print(text + "\n");
  }
  if (light.limit == raytrace::Limit::Stopped) {
    const std::string& file = call.output.empty() ? call.mesh : call.output;
    throw base::Error(base::Blame::Work, "solve", "interrupted", {},
                      file.empty() ? "" : "The partial result is in " + file);
  }
  if (light.surface.known) check_reached(call.scene, light.limit, error.value_or(0.0));
}

}  // namespace

radiosity::SolveOptions solve_options(const scenes::Scene& scene, const Common& common) {
  return radiosity::solve_options(scenes::resolve_quality(scene), common.seed);
}

Command add_solve(CLI::App& program) {
  CLI::App* parser = add_subcommand(program, "solve", "Radiosity alone: where the light goes");
  const auto call = std::make_shared<SolveCall>();
  add_scene_options(*parser, call->scene);
  parser
      ->add_option("-o,--output", call->output,
                   "The solution as HDF5, for render --solution and numpy; the report alone, as "
                   "JSON, if the name ends in .json")
      ->type_name("FILE");
  parser->add_option("--glb", call->mesh, "Also the solution as vertex colours for 3D viewers")
      ->type_name("FILE.glb");
  add_solution_option(*parser, call->solution);
  add_time_limit(*parser, call->time_limit_s,
                 "No longer than that for an error to reach; the numbers then differ between runs");
  parser->add_flag("--json", call->json, "JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
