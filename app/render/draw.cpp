// SPDX-License-Identifier: Apache-2.0
#include "app/render/draw.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/render/instants.h"
#include "app/render/light.h"
#include "app/render/render_parts.h"
#include "raytrace/paths/path_tracer.h"
#include "studies/cost/cost.h"
#include "studies/why/last_bounce.h"

namespace earthshine::app {
namespace {

raytrace::Frame trace(const RenderContext& context, const scenes::Camera& camera,
                      const raytrace::RenderOptions& options, const raytrace::Progress& progress) {
  const LoadedScene& loaded = context.loaded;
  return raytrace::trace_paths(
      loaded.world(context.query), camera,
      {options.columns, options.rows, options.gather_rays, options.per_light, options.paths,
       options.seed, options.stop, options.crop},
      progress);
}

// quality.gather_rays determines the number of paths.
bool as_set(const raytrace::RenderOptions& options) {
  return options.indirect == raytrace::Indirect::Paths;
}

raytrace::Limit limit_of(const Drawn& drawn, double wanted) {
  const bool explained = drawn.frame.report.unexplained_pixels == 0;
  if (explained && (drawn.errors.pixels == 0 || drawn.errors.total.estimate <= wanted)) {
    return raytrace::Limit::None;
  }
  if (drawn.frame.report.stopped) return raytrace::Limit::Stopped;
  const double most_s = drawn.options.time_limit_s;
  if (as_set(drawn.options) && (most_s <= 0.0 || drawn.frame.report.seconds < most_s)) {
    return raytrace::Limit::Settings;
  }
  const bool endless = most_s <= 0.0 || drawn.frame.report.gave_up;
  return endless ? raytrace::Limit::Steps : raytrace::Limit::Time;
}

constexpr int probe_rays = 16384;

std::string share_text(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

}  // namespace

PictureWork work_of(const raytrace::RenderOptions& options) {
  const bool part = options.crop.columns > 0;
  const double pixels = part ? double(options.crop.columns) * options.crop.rows
                             : double(options.columns) * options.rows;
  if (options.indirect == raytrace::Indirect::Paths) {
    return {Work::Paths, pixels * options.gather_rays};
  }
  // Rays grow as one over the squared error; neighbours share them, so that fewer more are needed.
  const double error = options.error > 0.0 ? options.error : 0.05;
  return {Work::Picture, pixels * 0.05 / error};
}

raytrace::Frame draw_frame(const RenderContext& context, const scenes::Camera& camera,
                           const raytrace::RenderOptions& options) {
  const LoadedScene& loaded = context.loaded;
  const auto [work, units] = work_of(options);
  const Progress::Listener progress =
      context.common.progress->begin("camera " + camera.name, work, units);
  if (options.indirect == raytrace::Indirect::Paths) {
    return trace(context, camera, options, progress);
  }
  return raytrace::render(loaded.world(context.query), context.light.solution, camera, options,
                          progress);
}

Drawn draw_picture(const RenderContext& context, const scenes::Camera& camera, StageTimes& times) {
  const LoadedScene& loaded = context.loaded;
  Drawn drawn;
  drawn.options = picture_options(context.call, context.common, loaded, camera);
  drawn.options.time_limit_s = context.time_limit_s;
  const raytrace::RenderOptions& options = drawn.options;
  const int instants = instants_of(loaded.scene, camera, options);
  drawn.frame = times.measure("render", [&] {
    if (instants > 1) return draw_instants(context, camera, options, instants);
    return context.parts != nullptr ? context.parts->picture(camera)
                                    : draw_frame(context, camera, options);
  });
  if (context.call.no_error) {
    drawn.errors.not_captured = raytrace::not_captured(context.scene(), options);
    return drawn;
  }
  drawn.errors = raytrace::error_budget(context.scene(), {&camera, options}, drawn.frame);
  if (const std::size_t pixels = drawn.frame.report.unexplained_pixels; pixels > 0) {
    drawn.errors.not_captured.push_back(
        fmt::format("light in {} pixels that the witness predicts and no sample found; the error "
                    "counts it as missing",
                    pixels));
  }
  const bool camera_moves =
      raytrace::make_camera_model(camera, options.columns, options.rows).moves();
  if (camera_moves && options.indirect == raytrace::Indirect::Radiosity) {
    drawn.errors.not_captured.emplace_back(
        "images of sources smaller than a pixel, which are not searched for by a camera that "
        "moves");
  }
  if (!loaded.scene.quality.error) return drawn;
  const double wanted = *loaded.scene.quality.error;
  drawn.limit = limit_of(drawn, wanted);
  if (drawn.limit != raytrace::Limit::None) {
    const double ratio = drawn.errors.total.estimate / wanted;
    const double growth =
        as_set(options) ? ratio * ratio : studies::samples_growth(drawn.frame.report, wanted);
    drawn.seconds_to_go = drawn.frame.report.seconds * (growth - 1.0);
  }
  if (context.light.solved) {
    raytrace::Step solve;
    solve.stage = "solve";
    solve.patches = context.light.solution.report.patches;
    solve.form_factor_rays = context.light.solution.report.rays_per_patch;
    solve.asked = wanted;
    drawn.steps.push_back(solve);
  }
  raytrace::Step picture;
  picture.stage = "picture";
  picture.gather_rays = drawn.frame.report.gather_rays;
  picture.asked = wanted;
  picture.estimate = drawn.errors.total.estimate;
  drawn.steps.push_back(picture);
  return drawn;
}

Json probe_json(const RenderContext& context, const scenes::Camera& camera,
                const raytrace::RenderOptions& options, const raytrace::Frame& frame) {
  const scenes::Scene& scene = context.loaded.scene;
  const auto luminance_of = [&frame](const std::string& layer) {
    Rgb colour(0.0);
    for (int c = 0; c < 3; ++c) {
      const base::Channel* channel =
          frame.image.find(layer + (layer.empty() ? "" : ".") + "RGB"[c]);
      if (channel != nullptr) colour[c] = static_cast<double>(channel->values.front());
    }
    return base::luminance(colour);
  };
  const double luminance = luminance_of("");
  std::vector<std::pair<double, std::string>> groups;
  for (const std::string& name : context.loaded.groups.names) {
    groups.emplace_back(luminance_of("light_" + name), name);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Json by = Json::array(), from = Json::array();
  for (const auto& [light, name] : groups) {
    by.push_back({{"group", name},
                  {"luminance_cd_m2", light},
                  {"share", luminance > 0.0 ? Json(light / luminance) : Json()}});
  }
  const std::uint32_t pixel =
      static_cast<std::uint32_t>(frame.window.y) * static_cast<std::uint32_t>(options.columns) +
      static_cast<std::uint32_t>(frame.window.x);
  const std::vector<studies::SeenPoint> points = studies::seen_points(
      scene, context.query, camera, options.columns, options.rows, {&pixel, 1}, 1);
  double rest = 1.0, others = 0.0;
  if (luminance > 0.0 && !points.empty() && !context.light.broken_off) {
    for (const studies::LightShare& share : studies::light_shares(
             context.scene(), context.light.solution, points, luminance, probe_rays)) {
      rest -= share.share;
      if (share.share < studies::least_light_share) {
        others += share.share;
        continue;
      }
      from.push_back(
          {{"from", share.from}, {"reflected", share.reflected}, {"share", share.share}});
    }
  }
  const bool is_lit = luminance > 0.0;
  return {{"light_by", by},
          {"light_from", from},
          {"others", is_lit ? Json(others) : Json()},
          {"left_over", is_lit ? Json(rest) : Json()}};
}

std::string probe_text(const Json& probe) {
  std::string text = "light by source, all its paths together (luminance):\n";
  for (const Json& entry : probe["light_by"]) {
    text +=
        fmt::format("  {:<24} {:>10.4g} cd/m2 {:>8}\n", entry["group"], entry["luminance_cd_m2"],
                    entry["share"].is_null() ? "-" : share_text(entry["share"].get<double>()));
  }
  text += "light by where it comes from last (diffuse, at the pixel's centre; of the luminance):\n";
  for (const Json& entry : probe["light_from"]) {
    text += fmt::format("  {:<24} {:>8}\n",
                        (entry["reflected"].get<bool>() ? "by way of " : "straight from ") +
                            entry["from"].get<std::string>(),
                        share_text(entry["share"].get<double>()));
  }
  if (!probe["left_over"].is_null()) {
    text += fmt::format("  {:<24} {:>8}\n", "others, below 1 % each",
                        share_text(probe["others"].get<double>()));
    text += fmt::format("  {:<24} {:>8}\n", "highlights, mirrors, rest",
                        share_text(probe["left_over"].get<double>()));
  }
  return text;
}

}  // namespace earthshine::app
