// SPDX-License-Identifier: Apache-2.0
// A picture during whose exposure objects or lamps move: the mean of pictures of several instants,
// each a scene of its own with a solution of its own (docs/decisions/0027-motion.md). A camera that
// moves alone needs none of this: its samples have times of their own.
#pragma once

#include "app/call/render_call.h"

namespace earthshine::app {

// Instants of the camera's exposure, so that nothing moves by more than a pixel between two of them
// (64 at most); 1: nothing moves by a tenth of a pixel, or nothing is exposed.
[[nodiscard]] int instants_of(const scenes::Scene& scene, const scenes::Camera& camera,
                              const raytrace::RenderOptions& options);

// Throws base::Error (Input) for a picture of several instants with --solution, --part or --probe.
void check_instants(const RenderCall& call, const scenes::Scene& scene,
                    const scenes::Camera& camera, const raytrace::RenderOptions& options);

// options: of the whole picture.
[[nodiscard]] raytrace::Frame draw_instants(const RenderContext& context,
                                            const scenes::Camera& camera,
                                            const raytrace::RenderOptions& options, int instants);

}  // namespace earthshine::app
