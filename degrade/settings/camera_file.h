// SPDX-License-Identifier: Apache-2.0
// Reads [[cctv]] and [monitor] tables of a scene or a camera file. docs/cctv.md lists the keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "degrade/parts/monitor.h"
#include "degrade/settings/presets.h"
#include "degrade/stage/camera.h"
#include "scenes/scene.h"

namespace earthshine::degrade {

// The camera of this name: a [[cctv]] table of the scene, else a preset. A table starts from
// `preset = "..."`, else from the preset of its name, else from the defaults of CctvCamera. Throws
// base::Error (Input) for an unknown name or key (with the nearest one), a value of the wrong type
// or out of range, a key without effect in this camera, noise in two forms, and contradictory
// limits. of, named_at: the user of the camera and the position, for messages.
[[nodiscard]] CctvCamera resolve_camera(const scenes::Scene& scene, const std::string& name,
                                        const std::string& of = {},
                                        const std::optional<base::Location>& named_at = {});

// The monitor for the camera of this name. The scene's [monitor] starts from the monitor of
// `preset = "..."`, else from the default one. Without this table it is the monitor of the camera's
// preset, else the default one. Throws as above.
[[nodiscard]] Monitor resolve_monitor(const scenes::Scene& scene, const std::string& name);

// A camera, its monitor, and the source of each setting in use: its position in the file, the
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

// Throws the errors of resolve_camera and resolve_monitor for all tables and all cameras of the
// scene.
void check_settings(const scenes::Scene& scene);

}  // namespace earthshine::degrade
