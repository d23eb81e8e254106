// SPDX-License-Identifier: Apache-2.0
#include "app/render/draw.h"

#include <fmt/format.h>

#include "app/console.h"
#include "app/render/light.h"
#include "app/render/render_parts.h"
#include "raytrace/paths/path_tracer.h"

namespace earthshine::app {
namespace {

raytrace::Frame trace(const Studio& studio, const scenes::Camera& camera,
                      const raytrace::RenderOptions& options, const raytrace::Progress& progress) {
  const LoadedScene& loaded = studio.loaded;
  return raytrace::trace_paths(
      loaded.scene, loaded.groups, loaded.effects, studio.query, camera,
      {options.columns, options.rows, options.gather_rays, options.per_light,
       raytrace::PathSet::All, options.seed, options.stop, options.crop},
      progress);
}

studies::Limit limit_of(const Drawn& drawn, double wanted) {
  if (drawn.errors.pixels == 0 || drawn.errors.total.estimate <= wanted) {
    return studies::Limit::None;
  }
  if (drawn.frame.report.stopped) return studies::Limit::Stopped;
  return drawn.options.time_limit_s > 0.0 ? studies::Limit::Time : studies::Limit::Steps;
}

// The squared error of samples falls as one over their number.
double seconds_to_go(const Drawn& drawn, double wanted) {
  const double ratio = drawn.errors.total.estimate / wanted;
  return drawn.frame.report.seconds * (ratio * ratio - 1.0);
}

}  // namespace

raytrace::Frame draw_frame(const Studio& studio, const scenes::Camera& camera,
                           const raytrace::RenderOptions& options) {
  const LoadedScene& loaded = studio.loaded;
  Progress progress(fmt::format("render {}", camera.name), studio.common.quiet);
  if (options.indirect == raytrace::Indirect::Paths) {
    return trace(studio, camera, options, std::ref(progress));
  }
  return raytrace::render(loaded.scene, loaded.groups, loaded.effects, studio.query,
                          studio.light.solution, camera, options, std::ref(progress));
}

Drawn draw_picture(const Studio& studio, const scenes::Camera& camera, StageTimes& times) {
  const LoadedScene& loaded = studio.loaded;
  Drawn drawn;
  drawn.options = picture_options(studio.call, studio.common, loaded, camera);
  drawn.options.time_limit_s = studio.time_limit_s;
  const raytrace::RenderOptions& options = drawn.options;
  drawn.frame = times.measure("render", [&] {
    return studio.parts != nullptr ? studio.parts->joined(camera)
                                   : draw_frame(studio, camera, options);
  });
  if (studio.call.no_error) {
    drawn.errors.not_captured = studies::not_captured(studio.scene(), options);
    return drawn;
  }
  drawn.errors = studies::error_budget(studio.scene(), {&camera, options}, drawn.frame);
  if (!steers(studio.call, loaded.scene)) return drawn;
  const double wanted = *loaded.scene.quality.error;
  drawn.limit = limit_of(drawn, wanted);
  if (drawn.limit != studies::Limit::None) drawn.seconds_to_go = seconds_to_go(drawn, wanted);
  if (studio.light.solved) {
    studies::Step solve;
    solve.stage = "solve";
    solve.patches = studio.light.solution.report.patches;
    solve.form_factor_rays = studio.light.solver.form_factor_rays;
    solve.asked = wanted;
    drawn.steps.push_back(solve);
  }
  studies::Step picture;
  picture.stage = "picture";
  picture.gather_rays = drawn.frame.report.gather_rays;
  picture.asked = wanted;
  picture.estimate = drawn.errors.total.estimate;
  drawn.steps.push_back(picture);
  return drawn;
}

}  // namespace earthshine::app
