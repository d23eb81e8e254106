// SPDX-License-Identifier: Apache-2.0
// [[cctv]] and [monitor] tables of a scene or a camera file to settings. docs/cctv.md lists the
// keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "degrade/parts/monitor.h"
#include "degrade/settings/presets.h"
#include "degrade/stage/camera.h"
#include "scenes/scene.h"

namespace earthshine::degrade {

// The camera of that name: a [[cctv]] table of the scene, else a preset. A table starts from
// `preset = "..."`, else from the preset of its own name, else from the defaults of CctvCamera.
// Throws base::Error (Input) for an unknown name or key (with the nearest), a value of the wrong
// kind or out of range, a key without effect in this camera, the noise given in two forms, and
// limits that contradict each other.
// of, named_at: what names it, and where, for the message.
[[nodiscard]] CctvCamera resolve_camera(const scenes::Scene& scene, const std::string& name,
                                        const std::string& of = {},
                                        const std::optional<base::Location>& named_at = {});

// The monitor that the camera of that name is watched on: the scene's [monitor], which starts from
// the monitor of `preset = "..."`, else from the default one; without that table the monitor of the
// preset that the camera is or starts from, else the default one. Throws as above.
[[nodiscard]] Monitor resolve_monitor(const scenes::Scene& scene, const std::string& name);

// A camera, its monitor, and where each setting in use comes from: the place in the file, the
// source that the preset states, or "default".
struct ResolvedCamera {
  std::string name;
  std::string about;
  CctvCamera camera;
  std::vector<SettingSource> sources;
  Monitor monitor;
  std::vector<SettingSource> monitor_sources;
};
[[nodiscard]] ResolvedCamera resolve(const scenes::Scene& scene, const std::string& name);
[[nodiscard]] ResolvedCamera resolve(const Preset& preset);

[[nodiscard]] std::vector<std::string> preset_names();

// Everything that resolve_camera and resolve_monitor would refuse, for all tables and all cameras
// of the scene.
void check_settings(const scenes::Scene& scene);

}  // namespace earthshine::degrade
