// SPDX-License-Identifier: Apache-2.0
// earthshine render: renders one or several cameras to linear EXR, PNG and the CCTV picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "app/call/memory.h"
#include "app/call/render_call.h"
#include "app/cctv/cctv.h"
#include "app/cctv/range.h"
#include "app/console.h"
#include "app/options.h"
#include "app/output.h"
#include "app/provenance.h"
#include "app/render/draw.h"
#include "app/render/effect_table.h"
#include "app/render/instants.h"
#include "app/render/light.h"
#include "app/render/render_parts.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "base/files/png_file.h"
#include "base/parallel.h"
#include "raytrace/camera/camera.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;

// The range sensor, and lines over a photograph, use no light.
void check_without_light(const RenderCall& call) {
  if (!call.range_alone() && !call.wire_alone()) return;
  const bool wire = call.wire_alone();
  const std::array<std::pair<const char*, bool>, 12> of_light = {
      {{"--json", call.json && wire},
       {"--timings", call.timings},
       {"--per-light", call.per_light},
       {"--aov", !call.aovs.empty()},
       {"--report", !call.report.empty()},
       {"--error", call.scene.wants_error()},
       {"--no-error", call.no_error},
       {"--indirect", call.indirect != raytrace::Indirect::Radiosity},
       {"--time-limit", call.time_limit_s > 0.0},
       {"--all-effects", call.all_effects},
       {"--solution", !call.solution.empty()},
       {"--exposure", call.tone.shared()}}};
  for (const auto& [option, asked] : of_light) {
    if (!asked) continue;
    throw Error(Blame::Input, option,
                wire ? "belongs to a picture, and --over alone draws lines"
                     : "belongs to a picture, and --range alone takes none",
                {}, "Add -o FILE.exr, or leave it out");
  }
}

void check_call(const RenderCall& call, bool quiet) {
  check_picture_options(call, quiet);
  const auto check_ending = [](const std::string& path, std::string_view option,
                               std::string_view ending) {
    if (path.empty() || path.ends_with(ending) || path.starts_with("/dev/")) return;
    throw Error(Blame::Input, option, fmt::format("\"{}\" is not a {} file", path, ending), {},
                fmt::format("Name a file that ends in {}", ending));
  };
  check_ending(call.output, "-o", ".exr");
  check_ending(call.png, "--png", ".png");
  check_ending(call.cctv, "--cctv", ".png");
  check_ending(call.range, "--range", ".exr");
  check_ending(call.report, "--report", ".json");
  check_over(call);
  note_unused_curve(call.tone, quiet);
  if (call.tone.shared() && call.png.empty()) {
    throw Error(Blame::Input, "--exposure", "is how a PNG is shown, and none is written", {},
                "Name one with --png, or leave --exposure out");
  }
  check_without_light(call);
  if (call.output.empty() && !call.only_pixel && !call.over.asked() && !call.range_alone()) {
    throw Error(Blame::Input, "--output", "is missing", {},
                "Name the picture: -o FILE.exr; only --range, --over, --probe and --only-pixel "
                "do without");
  }
  if (call.crop && !call.cctv.empty()) {
    throw Error(Blame::Input, "--cctv", "the CCTV stage needs the whole picture", {},
                fmt::format("Leave out --cctv or {}", call.crop_option()));
  }
  if (call.indirect == raytrace::Indirect::Paths && (call.crop || call.time_limit_s > 0.0)) {
    throw Error(Blame::Input, "--indirect paths", "draws whole pictures, however long it takes", {},
                fmt::format("Leave out {}", call.crop ? call.crop_option() : "--time-limit"));
  }
  if (call.probe && call.indirect != raytrace::Indirect::Radiosity) {
    throw Error(Blame::Input, "--probe", "reads the radiosity solution", {},
                "Leave --indirect out");
  }
  if (!call.solution.empty() && call.indirect != raytrace::Indirect::Radiosity) {
    throw Error(Blame::Input, "--solution",
                fmt::format("--indirect {} reads no solution", indirect_name(call.indirect)), {},
                "Leave one of the two out");
  }
}

// Rejects options that a part cannot handle alone, or that depend on the process.
void check_part(const RenderCall& call, bool quiet) {
  if (!call.part.in_parts()) return;
  note_unused_json(call.part, call.json, quiet);
  const std::array<std::pair<const char*, bool>, 6> not_in_parts = {
      {{call.pixel_option(), call.only_pixel},
       {"--time-limit", call.time_limit_s > 0.0},
       {"--report", !call.report.empty()},
       {"--timings", call.timings},
       {"--over", call.over.asked()},
       {"--range", call.output.empty()}}};
  for (const auto& [option, asked] : not_in_parts) {
    if (!asked) continue;
    throw Error(Blame::Input, "--part", fmt::format("does not go with {}", option), {},
                "Leave one of the two out");
  }
}

// "views/bay.exr" and camera A make "views/bay-A.exr".
std::string with_camera(const std::string& path, const std::string& camera) {
  if (path.empty() || path.starts_with("/dev/")) return path;
  const std::filesystem::path whole(path);
  return (whole.parent_path() / (whole.stem().string() + "-" + camera + whole.extension().string()))
      .string();
}

struct Wanted {
  const scenes::Camera* camera;
  PictureFiles files;
};

std::vector<Wanted> wanted_pictures(const RenderCall& call, const scenes::Scene& scene,
                                    bool quiet) {
  const auto cameras = each_once(wanted_cameras(call.cameras, scene));
  if (call.cameras.empty() && scene.cameras.size() > 1 && !quiet) {
    note("note: no --camera, taking the first, \"" + scene.cameras.front().name + "\"");
  }
  if ((call.only_pixel || call.over.asked()) && cameras.size() > 1) {
    throw Error(Blame::Input, call.only_pixel ? call.pixel_option() : "--over",
                "belongs to one camera", {}, "Name one --camera");
  }
  std::vector<Wanted> wanted;
  std::vector<std::string> outputs;
  for (const scenes::Camera* camera : cameras) {
    Wanted picture{camera, {call.output, call.png, call.cctv, call.range}};
    if (cameras.size() > 1) {
      for (std::string* path :
           {&picture.files.output, &picture.files.png, &picture.files.cctv, &picture.files.range}) {
        *path = with_camera(*path, file_stem(scene, *camera));
      }
    }
    outputs.insert(outputs.end(), {picture.files.output, picture.files.png, picture.files.cctv,
                                   picture.files.range});
    wanted.push_back(std::move(picture));
  }
  outputs.push_back(call.report);
  Files inputs = scene.files;
  inputs.insert(inputs.end(), {call.solution, call.over.photo});
  check_outputs(outputs, inputs);
  return wanted;
}

std::vector<const scenes::Camera*> cameras_of(const std::vector<Wanted>& pictures) {
  std::vector<const scenes::Camera*> cameras;
  for (const Wanted& picture : pictures) cameras.push_back(picture.camera);
  return cameras;
}

void expect_work(const RenderCall& call, const Common& common, const LoadedScene& loaded,
                 const std::vector<const scenes::Camera*>& cameras) {
  Progress& progress = *common.progress;
  if (loaded.effects.solution && call.solution.empty() &&
      call.indirect == raytrace::Indirect::Radiosity) {
    progress.expect(Work::Solve, static_cast<double>(loaded.scene.triangles.size()));
  }
  for (const scenes::Camera* camera : cameras) {
    const auto [work, units] = work_of(picture_options(call, common, loaded, *camera));
    progress.expect(work, units);
  }
  if (call.time_limit_s > 0.0) progress.end_within(call.time_limit_s);
}

// Leaves out the pictures of cameras inside a body; returns the cameras' names.
std::vector<std::string> leave_out_hidden(LoadedScene& loaded, const scenes::RayQuery& query,
                                          std::vector<Wanted>& pictures, bool quiet) {
  std::vector<std::string> skipped;
  for (const scenes::Camera* hidden :
       skip_hidden_cameras(loaded.scene, query, loaded.asked.cameras, quiet)) {
    skipped.push_back(hidden->name);
    std::erase_if(pictures, [&](const Wanted& picture) { return picture.camera == hidden; });
  }
  return skipped;
}

// Range pictures, one per picture if the call wants any.
std::vector<Json> sense_ranges(const LightCall& at, const std::vector<Wanted>& pictures,
                               StageTimes& times) {
  std::vector<Json> ranges;
  using Task = PartCall::Task;
  const bool writes = at.call.part.task == Task::All || at.call.part.task == Task::Merge;
  for (std::size_t k = 0; k < pictures.size() && writes && !at.call.range.empty(); ++k) {
    ranges.push_back(sense_range({at.loaded.scene, at.query, *pictures[k].camera, at.call.size},
                                 pictures[k].files.range, at.call.scene.overrides, at.common,
                                 times));
  }
  return ranges;
}

void check_pictures(const LightCall& at, const std::vector<Wanted>& pictures) {
  for (const Wanted& picture : pictures) {
    const raytrace::RenderOptions options =
        picture_options(at.call, at.common, at.loaded, *picture.camera);
    check_instants(at.call, at.loaded.scene, *picture.camera, options);
    check_memory(at.loaded, at.query, solve_options(at.loaded.scene, at.common), &options,
                 at.call.solution.empty());
  }
}

struct Taken {
  std::vector<Picture> pictures;
  Json reports = Json::array();
  bool whole = true;  // false: the last picture was interrupted
};

Taken take_pictures(RenderContext& context, const std::vector<Wanted>& pictures,
                    const std::vector<Json>& ranges, StageTimes& times) {
  Taken taken;
  for (std::size_t k = 0; k < pictures.size() && taken.whole; ++k) {
    if (context.call.time_limit_s > 0.0) {
      const double left = context.call.time_limit_s - times.total();
      context.time_limit_s = std::max(1e-3, left / static_cast<double>(pictures.size() - k));
    }
    context.number = k;
    if (k > 0) context.white_cd_per_m2 = taken.pictures.front().white_cd_per_m2;
    Picture picture = take_picture(context, *pictures[k].camera, pictures[k].files, times);
    times.add({{"pictures", picture.report["seconds"]["render"].get<double>()}});
    taken.whole = picture.whole;
    if (!ranges.empty()) picture.report["range"] = ranges[k]["range"];
    taken.reports.push_back(picture.report);
    taken.pictures.push_back(std::move(picture));
  }
  return taken;
}

// Lines over the photograph alone.
void write_wires(const LightCall& at, const scenes::Camera& camera) {
  const auto drawn = lay_over(at.call.over, *at.call.photo, at.loaded.scene, at.query, camera, {});
  base::write_png(at.call.png, drawn.width, drawn.height, 3, drawn.rgb);
}

// Throws if the call was interrupted, or ends short of its error or of its cameras.
void check_end(const RenderCall& call, const scenes::Scene& scene, const Taken& taken,
               const std::vector<Wanted>& pictures, const std::vector<std::string>& skipped) {
  if (!taken.whole) end_interrupted(pictures[taken.pictures.size() - 1].files);
  for (const Picture& picture : taken.pictures) {
    check_reached(call.scene, picture.limit, scene.quality.error.value_or(0.0));
  }
  check_skipped(skipped);
}

void run(RenderCall call, const Common& common) {
  check_call(call, common.quiet);
  check_part(call, common.quiet);
  StageTimes times;
  std::vector<Wanted> pictures;
  LoadedScene loaded = times.measure("read", [&] {
    return load(call.scene, common.quiet, [&](const scenes::Scene& scene) {
      pictures = wanted_pictures(call, scene, common.quiet);
      return wanted_effects(call, cameras_of(pictures));
    });
  });
  want_usual_error(call, loaded.scene);
  const auto query = times.measure("build", [&] { return scenes::RayQuery(loaded.scene); });
  const std::size_t asked = pictures.size();
  const std::vector<std::string> skipped = leave_out_hidden(loaded, query, pictures, common.quiet);
  check_input(loaded, query, {loaded.asked.cameras}, common.quiet);
  if (call.over.asked()) {
    call.photo = read_photo(call.over, *pictures.front().camera, common.quiet);
    call.size = Size{call.photo->width, call.photo->height};
  }
  const LightCall at{call, common, loaded, query, {}, Interrupt::asked};
  const std::vector<Json> ranges = sense_ranges(at, pictures, times);
  if (call.wire_alone()) return write_wires(at, *pictures.front().camera);
  if (call.range_alone()) {
    if (call.json) print(dump(ranges.size() == 1 ? ranges.front() : Json(ranges)));
    return check_skipped(skipped);
  }
  check_pictures(at, pictures);
  if (!call.part.in_parts()) expect_work(call, common, loaded, cameras_of(pictures));
  std::optional<Expectation> expected;
  if (!call.report.empty()) {
    expected = times.measure("pilot", [&] { return expect(loaded, call, common, query); });
  }
  const double cpu_before = base::cpu_seconds();
  std::optional<RenderParts> parts;
  if (call.part.in_parts()) {
    parts.emplace(LightCall{call, common, loaded, query}, call.part, cameras_of(pictures));
  }
  // A solution shared by several parts has no partial result.
  std::optional<Interrupt> interrupt;
  if (!parts) interrupt.emplace();
  const Solved light = parts ? parts->light(times) : find_light(at, times);
  RenderContext context{call, common, loaded, query, light};
  if (call.part.task == PartCall::Task::Solve) return;
  if (!interrupt) interrupt.emplace();
  if (call.part.task == PartCall::Task::Share) return parts->draw_share(context);
  if (call.part.task == PartCall::Task::Merge) {
    parts->check_complete();
    context.parts = &*parts;
  }
  const Taken taken = take_pictures(context, pictures, ranges, times);
  interrupt.reset();
  if (expected) {
    base::write_text(call.report,
                     dump(report_json(loaded, call, *expected, light.solution.report,
                                      taken.pictures, times, base::cpu_seconds() - cpu_before)));
  }
  if (call.json) print(dump(asked == 1 ? taken.reports.front() : taken.reports));
  check_end(call, loaded.scene, taken, pictures, skipped);
}

}  // namespace

Command add_render(CLI::App& program) {
  CLI::App* parser = add_subcommand(program, "render", "A camera's view: EXR, PNG, CCTV picture");
  const auto call = std::make_shared<RenderCall>();
  add_scene_options(*parser, call->scene);
  const auto file_option = [parser](const char* name, std::string& path, const char* help) {
    return parser->add_option(name, path, help)->type_name("FILE");
  };
  file_option("-o,--output", call->output, "Linear picture in cd/m2 (OpenEXR)");
  file_option("--png", call->png, "Also a tone-mapped picture");
  file_option("--cctv", call->cctv, "Also the picture on the camera's CCTV monitor (PNG)");
  parser->get_option("--cctv")->group("Output");
  add_tone_options(*parser, call->tone,
                   " (default); of several cameras the first one's white is that of all");
  file_option("--range", call->range,
              "Also, or alone, what the camera's range sensor reports (OpenEXR)");
  file_option("--report", call->report,
              "Also the plan's table with what each effect really took, as JSON");
  add_over_options(*parser, call->over);
  add_window_options(*parser, *call);
  add_part_options(*parser, call->part);
  add_solution_option(*parser, call->solution);
  add_picture_options(*parser, *call);
  parser->add_flag("--timings", call->timings,
                   "Write seconds per stage into the EXR header (bytes then differ between runs)");
  parser->add_flag("--json", call->json, "Report as JSON on standard output");
  return {parser, [call](const Common& common) { run(*call, common); }};
}

}  // namespace earthshine::app
