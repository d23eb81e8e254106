// SPDX-License-Identifier: Apache-2.0
// Where the light at a pixel comes from: by source, with all paths, and by last bounce.
#pragma once

#include "app/call/render_call.h"

namespace earthshine::app {

// "light_by": per light group `luminance_cd_m2` and `share`, from the frame's layers, and
// "light_from": `from`, `reflected`, `share` of the diffuse light at the pixel's centre
// (studies/why/last_bounce.h), "others", the sum of the small ones, and "left_over", the share that
// is neither. frame: one pixel, with per_light.
[[nodiscard]] Json probe_json(const Studio& studio, const scenes::Camera& camera,
                              const raytrace::RenderOptions& options, const raytrace::Frame& frame);
// For people, of what probe_json gives.
[[nodiscard]] std::string probe_text(const Json& probe);

}  // namespace earthshine::app
