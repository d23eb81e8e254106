// SPDX-License-Identifier: Apache-2.0
// earthshine render: scene to linear EXR, a viewable PNG and the CCTV picture.
#include "raytrace/render.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>

#include "app/cctv.h"
#include "app/command.h"
#include "app/console.h"
#include "app/memory.h"
#include "app/provenance.h"
#include "app/solution.h"
#include "base/error.h"
#include "base/exr_file.h"
#include "base/png_file.h"
#include "base/tone.h"
#include "scenes/quality.h"
#include "scenes/ray_query.h"

namespace earthshine::app {
namespace {

struct RenderCall {
  SceneInput scene;
  std::string output, png, cctv, camera, solution;
  std::optional<Size> size;
  raytrace::Indirect indirect = raytrace::Indirect::Radiosity;
  std::uint64_t distributed_lights = 64;
  std::string distributed_over;
  std::vector<std::string> aovs;
  bool per_light = false, timings = false, json = false;
};

void check_call(const RenderCall& call) {
  for (const std::string& name : call.aovs) {
    const std::vector<std::string>& known = raytrace::aov_names();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw base::Error(base::Blame::Input, "--aov", "there is no layer \"" + name + "\"",
                      fmt::format("the layers are {}", fmt::join(known, ", ")));
  }
  const auto check_ending = [](const std::string& path, std::string_view option,
                               std::string_view ending) {
    if (path.empty() || path.ends_with(ending) || path.starts_with("/dev/")) return;
    throw base::Error(base::Blame::Input, option,
                      fmt::format("\"{}\" is not a {} file", path, ending), {},
                      fmt::format("Name a file that ends in {}", ending));
  };
  check_ending(call.output, "-o", ".exr");
  check_ending(call.png, "--png", ".png");
  check_ending(call.cctv, "--cctv", ".png");
  check_outputs({call.output, call.png, call.cctv}, {call.scene.path, call.solution});
  if (!call.solution.empty() && call.indirect != raytrace::Indirect::Radiosity) {
    throw base::Error(base::Blame::Input, "--solution",
                      fmt::format("--indirect {} reads no solution", indirect_name(call.indirect)),
                      {}, "Leave one of the two out");
  }
  if (!call.distributed_over.empty() && call.indirect != raytrace::Indirect::Distributed) {
    throw base::Error(base::Blame::Input, "--distributed-over",
                      fmt::format("--indirect {} spreads no lights", indirect_name(call.indirect)),
                      {}, "Write --indirect distributed");
  }
}

struct Rendered {
  radiosity::Solution solution;
  raytrace::Frame frame;
  raytrace::RenderOptions options;
  radiosity::SolveOptions solver;
  bool solved = false;
};

Rendered compute(const RenderCall& call, const Common& common, const LoadedScene& loaded,
                 const scenes::Camera& camera, StageTimes& times) {
  const scenes::RayQuery query =
      times.measure("build", [&] { return scenes::RayQuery(loaded.scene); });
  Rendered r;
  r.solver = solve_options(loaded.scene, common);
  r.options.columns = call.size ? call.size->columns : camera.columns;
  r.options.rows = call.size ? call.size->rows : camera.rows;
  r.options.gather_rays = scenes::resolve_quality(loaded.scene).gather_rays;
  r.options.indirect = call.indirect;
  r.options.distributed_lights = static_cast<int>(call.distributed_lights);
  r.options.distributed_over = call.distributed_over;
  r.options.per_light = call.per_light;
  r.options.aovs = call.aovs;
  r.options.seed = common.seed;
  check_memory(loaded, query, r.solver, &r.options, call.solution.empty());
  if (call.indirect == raytrace::Indirect::Radiosity) {
    if (loaded.groups.count() == 0) note("note: nothing gives light, the picture is black");
    r.solution = solve_or_read(loaded, query, r.solver, call.solution, times);
    r.solved = true;
    if (!common.quiet) note_backs(r.solution.report);
  }
  Progress progress("render", common.quiet);
  r.frame = times.measure("render", [&] {
    return raytrace::render(loaded.scene, loaded.groups, loaded.effects, query, r.solution, camera,
                            r.options, std::ref(progress));
  });
  return r;
}

Json json_of(const Rendered& r, const StageTimes& times) {
  const raytrace::RayCounts& rays = r.frame.report.rays;
  const radiosity::SolveReport& solved = r.solution.report;
  return {{"columns", r.options.columns},
          {"rows", r.options.rows},
          {"seconds", times.json()},
          {"peak_memory_mib", peak_memory_mib()},
          {"patches", solved.patches},
          {"iterations", solved.iterations},
          {"residual", solved.residual},
          {"rays",
           {{"form_factors", solved.form_factor_rays},
            {"direct", solved.shadow_rays},
            {"camera", rays.camera},
            {"shadow", rays.shadow},
            {"gather", rays.gather},
            {"lobe", rays.lobe},
            {"mirror", rays.mirror}}},
          {"relative_noise", r.frame.report.relative_noise}};
}

void report(const Rendered& r, const StageTimes& times) {
  for (const auto& [stage, seconds] : times.stages()) {
    note(fmt::format("  {:<16} {:>10}", stage, duration(seconds)));
  }
  note(fmt::format("  {:<16} {:>10}, peak memory {:.0f} MiB", "total", duration(times.total()),
                   peak_memory_mib()));
  const radiosity::SolveReport& solved = r.solution.report;
  if (r.solved && solved.patches > 0) {
    note(fmt::format("  {} patches, {} form-factor and {} shadow rays, {} iterations to {:.1g}",
                     solved.patches, short_count(static_cast<double>(solved.form_factor_rays)),
                     short_count(static_cast<double>(solved.shadow_rays)), solved.iterations,
                     solved.residual));
  }
  const auto rays = static_cast<double>(r.frame.report.rays.total());
  note(fmt::format("  {} rays for the picture, {} rays/s; noise {:.2g} of the mean",
                   short_count(rays), short_count(rays / std::max(1e-9, r.frame.report.seconds)),
                   r.frame.report.relative_noise));
}

void run(const RenderCall& call, const Common& common) {
  check_call(call);
  StageTimes times;
  const LoadedScene loaded = times.measure("read", [&] { return load(call.scene, common.quiet); });
  const scenes::Camera& camera = choose_camera(loaded.scene, call.camera);
  if (call.camera.empty() && loaded.scene.cameras.size() > 1 && !common.quiet) {
    note("note: no --camera, taking the first, \"" + camera.name + "\"");
  }
  std::optional<CctvSetup> cctv;
  if (!call.cctv.empty()) cctv = cctv_of_camera(loaded.scene, camera, common);
  const Rendered r = compute(call, common, loaded, camera, times);
  std::optional<base::ToneMapped> tone;
  std::optional<degrade::Result> screen;
  if (!call.png.empty()) {
    tone = times.measure("tone map", [&] { return base::tone_map(r.frame.image); });
  }
  if (cctv) screen = times.measure("cctv", [&] { return run_chain(*cctv, r.frame.image); });
  base::ExrHeader header =
      provenance_header({loaded.scene, call.scene.overrides, camera, r.options, r.solver,
                         r.solved ? &r.solution.report : nullptr, r.frame.report});
  if (call.timings) add_times(header, times);
  times.measure("write", [&] {
    if (tone) base::write_png(call.png, r.options.columns, r.options.rows, 3, tone->rgb);
    if (screen) write_cctv(call.cctv, *cctv, *screen);
    base::write_exr(call.output, r.frame.image, header);
  });
  if (call.json) {
    Json json = json_of(r, times);
    if (screen) json["cctv"] = cctv_json(*cctv, *screen);
    print(dump(json));
  }
  if (common.quiet) return;
  report(r, times);
  if (screen) note("  " + cctv_summary(*cctv, *screen));
}

}  // namespace

Command add_render(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("render", "A camera's view: EXR, PNG, CCTV picture");
  const auto call = std::make_shared<RenderCall>();
  add_scene_options(*parser, call->scene);
  const auto file_option = [parser](const char* name, std::string& path, const char* help) {
    return parser->add_option(name, path, help)->type_name("FILE");
  };
  file_option("-o,--output", call->output, "Linear picture in cd/m2 (OpenEXR)")->required();
  file_option("--png", call->png, "Also a tone-mapped picture");
  file_option("--cctv", call->cctv, "Also the picture on the camera's CCTV monitor (PNG)");
  parser->add_option("--camera", call->camera, "Camera of the scene (default: its first)")
      ->type_name("NAME");
  add_size_option(*parser, call->size);
  add_solution_option(*parser, call->solution);
  using raytrace::Indirect;
  const std::map<std::string, Indirect> names = {{"radiosity", Indirect::Radiosity},
                                                 {"distributed", Indirect::Distributed},
                                                 {"none", Indirect::None}};
  parser
      ->add_option_function<std::string>(
          "--indirect",
          [call, names](const std::string& text) {
            const auto known = names.find(text);
            if (known == names.end()) {
              throw CLI::ValidationError(
                  "--indirect", "\"" + text + "\" is not one of radiosity, distributed, none");
            }
            call->indirect = known->second;
          },
          "radiosity (default), distributed (many lights, no interreflection), none")
      ->type_name("HOW");
  add_whole_number(*parser, "--distributed-lights", call->distributed_lights, 1, 1U << 20U,
                   "Lights of --indirect distributed (default 64)");
  parser
      ->add_option("--distributed-over", call->distributed_over,
                   "Spread the Earth's lights over this [[area]] of the scene, not its disc")
      ->type_name("NAME");
  parser
      ->add_option_function<std::string>(
          "--aov", [call](const std::string& text) { call->aovs = split_at_commas(text); },
          fmt::format("Further layers, of {}", fmt::join(raytrace::aov_names(), ",")))
      ->type_name("LIST");
  parser->add_flag("--per-light", call->per_light, "One layer per light group: light_<group>.R …");
  parser->add_flag("--timings", call->timings,
                   "Write seconds per stage into the EXR header (bytes then differ between runs)");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
