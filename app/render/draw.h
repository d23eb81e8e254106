// SPDX-License-Identifier: Apache-2.0
// One camera's picture, drawn as the call wants it: with the scene's settings, within a time, or
// until it is as exact as wanted.
#pragma once

#include "app/call/render_call.h"
#include "base/files/exr_file.h"

namespace earthshine::app {

struct Drawn {
  raytrace::Frame frame;
  raytrace::RenderOptions options;  // that it was drawn with
  raytrace::ErrorBudget errors;
  std::vector<raytrace::Step> steps;  // with an error to reach: of the solution, then the picture's
  raytrace::Limit limit = raytrace::Limit::None;
  double seconds_to_go = 0.0;  // about, until the wanted error, if it was not reached
};
// A picture's units of work (app/progress.h).
struct PictureWork {
  Work work;
  double units;
};
[[nodiscard]] PictureWork work_of(const raytrace::RenderOptions& options);
// Rays alone, without a statement of what they are worth.
[[nodiscard]] raytrace::Frame draw_frame(const Studio& studio, const scenes::Camera& camera,
                                         const raytrace::RenderOptions& options);
[[nodiscard]] Drawn draw_picture(const Studio& studio, const scenes::Camera& camera,
                                 StageTimes& times);

// Size, rays, patches and seconds of a frame, as --json reports them.
[[nodiscard]] Json frame_json(const Studio& studio, const scenes::Camera& camera,
                              const raytrace::Frame& frame, const StageTimes& times);
// The header of its EXR file: provenance, place in the whole picture, stated error.
[[nodiscard]] base::ExrHeader picture_header(const Studio& studio, const scenes::Camera& camera,
                                             const Drawn& drawn);

// Where the light at a pixel comes from: by source, with all paths, and by last bounce.

// "light_by": per light group `luminance_cd_m2` and `share`, from the frame's layers, and
// "light_from": `from`, `reflected`, `share` of the diffuse light at the pixel's centre
// (studies/why/last_bounce.h), "others", the sum of the small ones, and "left_over", the share that
// is neither. frame: one pixel, with per_light.
[[nodiscard]] Json probe_json(const Studio& studio, const scenes::Camera& camera,
                              const raytrace::RenderOptions& options, const raytrace::Frame& frame);
// For people, of what probe_json gives.
[[nodiscard]] std::string probe_text(const Json& probe);

}  // namespace earthshine::app
