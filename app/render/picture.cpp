// SPDX-License-Identifier: Apache-2.0
// One camera's picture: rendered, degraded, written, reported.
#include <fmt/format.h>

#include <sstream>

#include "app/call/render_call.h"
#include "app/cctv/cctv.h"
#include "app/console.h"
#include "app/provenance.h"
#include "app/render/draw.h"
#include "app/render/error_json.h"
#include "app/render/light.h"
#include "base/error.h"
#include "base/files/exr_file.h"
#include "base/files/png_file.h"
#include "base/tone.h"
#include "scenes/effects/quality.h"

namespace earthshine::app {
namespace {

std::string name_of(std::size_t light_kind) {
  return std::string(scenes::effect_of(static_cast<scenes::LightKind>(light_kind)));
}
Json rays_by_light(const raytrace::RayCounts& rays) {
  Json counts = Json::object();
  for (std::size_t k = 0; k < scenes::light_kinds; ++k) counts[name_of(k)] = rays.to_light[k];
  return counts;
}
Json rays_by_light(const radiosity::SolveReport& solved) {
  Json counts = Json::object();
  for (std::size_t k = 0; k < scenes::light_kinds; ++k) {
    counts[name_of(k)] = solved.sources_cost[k].rays;
  }
  return counts;
}

}  // namespace

Json frame_json(const RenderContext& context, const scenes::Camera& camera,
                const raytrace::Frame& frame, const StageTimes& times) {
  const raytrace::RenderReport& report = frame.report;
  const raytrace::RayCounts& rays = report.rays;
  const radiosity::SolveReport& solved = context.light.solution.report;
  Json json = {{"camera", camera.name},
               {"columns", frame.image.width},
               {"rows", frame.image.height},
               {"seconds", times.json()},
               {"warnings", context.loaded.scene.warnings},
               {"peak_memory_mib", peak_memory_mib()},
               {"patches", solved.patches},
               {"iterations", solved.iterations},
               {"residual", solved.residual},
               {"rays",
                {{"form_factors", solved.form_factor_rays},
                 {"direct", solved.shadow_rays},
                 {"direct_by", rays_by_light(solved)},
                 {"camera", rays.camera},
                 {"shadow", rays.shadow},
                 {"gather", rays.gather},
                 {"lobe", rays.lobe},
                 {"mirror", rays.mirror},
                 {"refraction", rays.refraction},
                 {"planning", rays.planning},
                 {"layers", rays.layers},
                 {"shadow_by", rays_by_light(rays)}}},
               {"gather_rays", report.gather_rays},
               {"camera_samples", report.camera_samples},
               {"relative_noise", report.relative_noise},
               {"finished_share", report.finished_share},
               {"partial", report.stopped}};
  // Solution files do not store the cost by kind of light.
  if (!context.call.solution.empty() || context.parts != nullptr) json["rays"].erase("direct_by");
  return json;
}

base::ExrHeader picture_header(const RenderContext& context, const scenes::Camera& camera,
                               const Drawn& drawn) {
  const raytrace::RenderOptions& options = drawn.options;
  const Solved& light = context.light;
  base::ExrHeader header = provenance_header(
      {context.loaded.scene, context.call.scene.overrides, camera, options, light.solver,
       light.solved ? &light.solution.report : nullptr, drawn.frame.report});
  header.whole = {options.columns, options.rows, drawn.frame.window.x, drawn.frame.window.y};
  add_errors(header, drawn);
  return header;
}

namespace {

// The pixel of --only-pixel, layer by layer.
Json pixel_json(const scenes::Scene& scene, const raytrace::Frame& frame) {
  const auto value = [&](const char* channel) {
    return double(frame.image.find(channel)->values.front());
  };
  const auto name_of = [](const auto& list, double index) {
    return index < 0.0 ? Json(nullptr) : Json(list[static_cast<std::size_t>(index)].name);
  };
  Json pixel = {{"x", frame.window.x}, {"y", frame.window.y}};
  pixel["luminance_cd_m2"] = base::luminance({value("R"), value("G"), value("B")});
  pixel["standard_error_cd_m2"] = std::sqrt(value("variance"));
  pixel["camera_samples"] = frame.report.camera_samples;
  pixel["object"] = name_of(scene.objects, value("object"));
  pixel["material"] = name_of(scene.materials, value("material"));
  Json channels = Json::object();
  for (const base::Channel& channel : frame.image.channels) {
    channels[channel.name] = double(channel.values.front());
  }
  pixel["channels"] = channels;
  return pixel;
}

std::string pixel_text(const Json& pixel) {
  std::string text = fmt::format(
      "pixel {},{}: {:.6g} cd/m2 +- {:.2g}, {:.0f} camera samples, {}\n", pixel["x"], pixel["y"],
      pixel["luminance_cd_m2"], pixel["standard_error_cd_m2"], pixel["camera_samples"],
      pixel["object"].is_null()
          ? std::string("nothing there")
          : fmt::format("object \"{}\", material \"{}\"", pixel["object"], pixel["material"]));
  for (const auto& [name, value] : pixel["channels"].items()) {
    text += fmt::format("  {:<20} {:.9g}\n", name, value.get<double>());
  }
  return text;
}

base::ToneMapped toned(const RenderContext& context, const base::Image& image) {
  const ToneChoice& choice = context.call.tone;
  if (!choice.shared()) return base::tone_map(image);
  return base::expose(
      image, context.white_cd_per_m2 ? *context.white_cd_per_m2 : white_of(choice, {&image}),
      choice.curve);
}

void note_results(const RenderContext& context, const scenes::Camera& camera,
                  const PictureFiles& files, const raytrace::Frame& frame,
                  const StageTimes& times) {
  std::vector<std::string> written;
  for (const std::string& file : {files.output, files.png, files.cctv, files.range}) {
    if (!file.empty()) written.push_back(file);
  }
  note(fmt::format("camera {}{}{}", camera.name, written.empty() ? "" : ": ",
                   fmt::join(written, ", ")));
  // The stages before the first picture serve all.
  const bool first = context.number == 0;
  for (const auto& [stage, seconds] : times.stages()) {
    if (!first && stage != "render" && stage != "write") continue;
    note(fmt::format("  {:<16} {:>10}", stage, duration(seconds)));
  }
  note(fmt::format("  {:<16} {:>10}, peak memory {:.0f} MiB", "total", duration(times.total()),
                   peak_memory_mib()));
  const radiosity::SolveReport& solved = context.light.solution.report;
  if (first && context.light.solved && solved.patches > 0) {
    note(fmt::format("  {} patches, {} form-factor and {} shadow rays, {} iterations to {:.1g}",
                     solved.patches, short_count(static_cast<double>(solved.form_factor_rays)),
                     short_count(static_cast<double>(solved.shadow_rays)), solved.iterations,
                     solved.residual));
  }
  const raytrace::RenderReport& report = frame.report;
  const auto rays = static_cast<double>(report.rays.total());
  note(fmt::format(
      "  {} rays for the picture, {} rays/s; {} gather rays and {:.1f} camera samples a "
      "pixel; noise {:.2g} of the mean",
      short_count(rays), short_count(rays / std::max(1e-9, report.seconds)), report.gather_rays,
      report.camera_samples, report.relative_noise));
  if (report.stopped) {
    note(fmt::format("  stopped: {:.0f} % of the pixels are finished",
                     100.0 * report.finished_share));
  }
}

}  // namespace

raytrace::RenderOptions picture_options(const RenderCall& call, const Common& common,
                                        const LoadedScene& loaded, const scenes::Camera& camera) {
  raytrace::RenderOptions options = raytrace::render_options(scenes::resolve_quality(loaded.scene));
  options.columns = call.size ? call.size->columns : camera.columns;
  options.rows = call.size ? call.size->rows : camera.rows;
  if (call.indirect == raytrace::Indirect::Paths && !loaded.scene.quality.gather_rays) {
    options.gather_rays *= scenes::paths_per_gather_ray;
  }
  if (steers(call, loaded.scene)) options.error = *loaded.scene.quality.error;
  if (call.crop) options.crop = *call.crop;
  if (call.only_pixel && (call.crop->x >= options.columns || call.crop->y >= options.rows)) {
    throw base::Error(base::Blame::Input, call.pixel_option(),
                      fmt::format("{},{} lies outside the picture", call.crop->x, call.crop->y),
                      fmt::format("0,0 to {},{}", options.columns - 1, options.rows - 1));
  }
  options.indirect = call.indirect;
  if (call.distributed_lights) {
    options.distributed_lights = static_cast<int>(*call.distributed_lights);
  }
  options.distributed_over = call.distributed_over;
  options.per_light = call.per_light;
  if (call.no_caustics) options.paths = raytrace::PathSet::NoCaustics;
  options.aovs = call.aovs;
  if (call.only_pixel) {
    for (const char* layer : {"object", "material", "range", "variance"}) {
      options.aovs.emplace_back(layer);
    }
  }
  options.seed = common.seed;
  options.stop = Interrupt::asked;
  return options;
}

Picture take_picture(const RenderContext& context, const scenes::Camera& camera,
                     const PictureFiles& files, StageTimes times) {
  const RenderCall& call = context.call;
  std::optional<CctvSetup> cctv;
  if (!files.cctv.empty()) cctv = cctv_of_camera(context.loaded.scene, camera, context.common);
  const Drawn drawn = draw_picture(context, camera, times);
  const raytrace::Frame& frame = drawn.frame;
  const raytrace::RenderOptions& options = drawn.options;
  std::optional<base::ToneMapped> tone;
  std::optional<degrade::Result> screen;
  if (!files.png.empty()) {
    tone = times.measure("tone map", [&] { return toned(context, frame.image); });
  }
  if (tone && call.photo) {
    tone->rgb = times.measure("over", [&] {
      return lay_over(call.over, *call.photo, context.loaded.scene, context.query, camera,
                      tone->rgb)
          .rgb;
    });
  }
  if (cctv) screen = times.measure("cctv", [&] { return run_chain(*cctv, frame.image); });
  base::ExrHeader header = picture_header(context, camera, drawn);
  if (call.timings) add_times(header, times);
  times.measure("write", [&] {
    const HeaderTexts mark = partial_mark(header);
    if (tone) base::write_png(files.png, frame.image.width, frame.image.height, 3, tone->rgb, mark);
    if (screen) write_cctv(files.cctv, *cctv, *screen, mark);
    if (!files.output.empty()) base::write_exr(files.output, frame.image, header);
  });
  Picture picture{frame_json(context, camera, frame, times),
                  !frame.report.stopped,
                  drawn.limit,
                  frame.report,
                  {},
                  {}};
  picture.times = times;
  if (tone && call.tone.shared()) {
    picture.white_cd_per_m2 = tone->report.white_cd_per_m2;
    picture.report["png_white_cd_m2"] = tone->report.white_cd_per_m2;
  }
  const std::optional<double> wanted =
      call.no_error ? std::nullopt : context.loaded.scene.quality.error;
  picture.report["error"] = error_json(drawn, wanted);
  if (screen) picture.report["cctv"] = cctv_json(*cctv, *screen);
  if (call.only_pixel) {
    Json& pixel = picture.report["pixel"];
    pixel = pixel_json(context.loaded.scene, frame);
    if (call.probe) pixel.update(probe_json(context, camera, options, frame));
    if (!call.json) {
      const std::string text = pixel_text(pixel);
      // The first line names the pixel, the next lines its layers.
      print(call.probe ? text.substr(0, text.find('\n') + 1) + probe_text(pixel) : text);
    }
  }
  if (context.common.quiet) return picture;
  note_results(context, camera, files, frame, times);
  if (!call.no_error) {
    std::istringstream lines("  " + error_text(drawn, wanted));
    for (std::string line; std::getline(lines, line);) note(line);
  }
  if (screen) note("  " + cctv_summary(*cctv, *screen));
  return picture;
}

void end_interrupted(const PictureFiles& last) {
  std::vector<std::string> files;
  for (const std::string& file : {last.output, last.png, last.cctv}) {
    if (!file.empty()) files.push_back(file);
  }
  const std::string say = files.size() == 1 ? "says it is" : "say they are";
  throw base::Error(base::Blame::Work, "render", "interrupted", {},
                    files.empty() ? ""
                                  : fmt::format("The finished part is in {}, which {} partial",
                                                fmt::join(files, ", "), say));
}

}  // namespace earthshine::app
