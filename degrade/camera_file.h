// SPDX-License-Identifier: Apache-2.0
// [[cctv]] and [monitor] tables of a scene to settings. docs/cctv.md lists the keys.
#pragma once

#include <string>

#include "degrade/camera.h"
#include "degrade/monitor.h"
#include "scenes/scene.h"

namespace earthshine::degrade {

// The camera of that name: a [[cctv]] table of the scene, else a preset. A table starts from
// `preset = "..."`, else from the preset of its own name, else from the defaults of CctvCamera.
// Throws base::Error (Input) for an unknown name or key (with the nearest), a value of the wrong
// kind or out of range, a key without effect in this camera, and limits that contradict each other.
[[nodiscard]] CctvCamera resolve_camera(const scenes::Scene& scene, const std::string& name);

// The scene's [monitor], or the default one. Throws as above.
[[nodiscard]] Monitor resolve_monitor(const scenes::Scene& scene);

// Everything that resolve_camera and resolve_monitor would refuse, for all tables and all cameras
// of the scene.
void check_settings(const scenes::Scene& scene);

}  // namespace earthshine::degrade
