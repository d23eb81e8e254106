// SPDX-License-Identifier: Apache-2.0
// Which stages of a CCTV camera run, and the settings that decided.
#pragma once

#include "app/command.h"
#include "scenes/scene.h"

namespace earthshine::app {

// {"stage", "runs", "why"} of every stage in order; empty when no CCTV model is named or asked for.
// asked: the call wants the picture on the monitor, of the default model if the camera names none.
[[nodiscard]] Json plan_cctv(const scenes::Scene& scene, const scenes::Camera& camera, bool asked);

}  // namespace earthshine::app
