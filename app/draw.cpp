// SPDX-License-Identifier: Apache-2.0
#include "app/draw.h"

#include <fmt/format.h>

#include "app/console.h"
#include "app/light.h"
#include "raytrace/path_tracer.h"

namespace earthshine::app {
namespace {

Drawn draw_as_exactly(const Studio& studio, const scenes::Camera& camera,
                      const raytrace::RenderOptions& options, const raytrace::Progress& progress) {
  const Solved& light = studio.light;
  const StageTimes from_now;
  const studies::Trial trial =
      studio.number < light.trials.size() ? light.trials[studio.number] : studies::Trial{};
  studies::SteeredPicture found = studies::reach_picture(
      studio.scene(), wanted_error(studio.loaded, studio.common, studio.time_limit_s, from_now),
      light.solution, light.errors[studio.number], {&camera, options}, trial, progress);
  Drawn drawn{std::move(found.frame), found.options, std::move(found.budget), light.steps,
              found.limit};
  drawn.steps.insert(drawn.steps.end(), found.steps.begin(), found.steps.end());
  const bool reached = drawn.errors.parts.total().estimate <= *studio.loaded.scene.quality.error;
  if (reached) drawn.limit = studies::Limit::None;
  if (!reached && light.limit != studies::Limit::None) drawn.limit = light.limit;
  return drawn;
}

raytrace::Frame trace(const Studio& studio, const scenes::Camera& camera,
                      const raytrace::RenderOptions& options, const raytrace::Progress& progress) {
  const LoadedScene& loaded = studio.loaded;
  return raytrace::trace_paths(
      loaded.scene, loaded.groups, loaded.effects, studio.query, camera,
      {options.columns, options.rows, options.gather_rays, options.per_light,
       raytrace::PathSet::All, options.seed, options.stop},
      progress);
}

}  // namespace

Drawn draw_picture(const Studio& studio, const scenes::Camera& camera, StageTimes& times) {
  const LoadedScene& loaded = studio.loaded;
  raytrace::RenderOptions options = picture_options(studio.call, studio.common, loaded, camera);
  Progress progress(fmt::format("render {}", camera.name), studio.common.quiet);
  if (steers(studio.call, loaded.scene)) {
    return times.measure(
        "render", [&] { return draw_as_exactly(studio, camera, options, std::ref(progress)); });
  }
  Drawn drawn;
  drawn.options = options;
  drawn.options.time_limit_s = studio.time_limit_s;
  drawn.frame = times.measure("render", [&] {
    if (options.indirect == raytrace::Indirect::Paths) {
      return trace(studio, camera, options, std::ref(progress));
    }
    return raytrace::render(loaded.scene, loaded.groups, loaded.effects, studio.query,
                            studio.light.solution, camera, drawn.options, std::ref(progress));
  });
  drawn.errors = times.measure("error", [&] {
    return studies::error_budget(studio.scene(), studio.light.errors[studio.number],
                                 studio.light.solution, {&camera, options}, drawn.frame);
  });
  return drawn;
}

}  // namespace earthshine::app
