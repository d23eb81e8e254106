// SPDX-License-Identifier: Apache-2.0
// Renders one camera's picture: with the scene's settings, within a time limit, or to a wanted
// error.
#pragma once

#include "app/call/render_call.h"
#include "base/files/exr_file.h"

namespace earthshine::app {

struct Drawn {
  raytrace::Frame frame;
  raytrace::RenderOptions options;  // used settings
  raytrace::ErrorBudget errors;
  std::vector<raytrace::Step> steps;  // with a wanted error: of the solution, then of the picture
  raytrace::Limit limit = raytrace::Limit::None;
  double seconds_to_go = 0.0;  // estimate until the wanted error, if it was not reached
};
// A picture's units of work (app/progress.h).
struct PictureWork {
  Work work;
  double units;
};
[[nodiscard]] PictureWork work_of(const raytrace::RenderOptions& options);
// Rays alone, without a statement of what they are worth.
[[nodiscard]] raytrace::Frame draw_frame(const RenderContext& context, const scenes::Camera& camera,
                                         const raytrace::RenderOptions& options);
[[nodiscard]] Drawn draw_picture(const RenderContext& context, const scenes::Camera& camera,
                                 StageTimes& times);

// Size, rays, patches and seconds of a frame, for --json.
[[nodiscard]] Json frame_json(const RenderContext& context, const scenes::Camera& camera,
                              const raytrace::Frame& frame, const StageTimes& times);
// The header of its EXR file: provenance, position in the whole picture, stated error.
[[nodiscard]] base::ExrHeader picture_header(const RenderContext& context,
                                             const scenes::Camera& camera, const Drawn& drawn);

// Origin of a pixel's light: by source, with all paths, and by last bounce.

// "light_by": per light group `luminance_cd_m2` and `share`, from the frame's layers. "light_from":
// `from`, `reflected`, `share` of the diffuse light at the pixel's centre
// (studies/why/last_bounce.h). "others": sum of small contributions. "left_over": the remaining
// share. frame: one pixel, with per_light.
[[nodiscard]] Json probe_json(const RenderContext& context, const scenes::Camera& camera,
                              const raytrace::RenderOptions& options, const raytrace::Frame& frame);
// Text for people from probe_json.
[[nodiscard]] std::string probe_text(const Json& probe);

}  // namespace earthshine::app
