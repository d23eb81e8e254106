// SPDX-License-Identifier: Apache-2.0
// Reads a TOML scene file to a Scene (docs/scene-format.md).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Reads a scene and its meshes. Each override is "key=value" with a dotted path and a TOML value:
// "quality.gather_rays=64", "sun.illuminance=0", "light.fwd-bulkhead.intensity=0" (the entry with
// this name), "camera.A.fov_deg=30". Overrides are checked like the file's own keys. They may
// create plain tables (sun, earth, orbit, ambient, quality, monitor) but not named entries.
// overrides_at: places of the overrides in a file, for messages; empty: --set on the command line.
// Throws base::Error (Input) with the place (file:line:column), the value found, the allowed values
// and a remedy.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path,
                               std::span<const std::string> overrides = {},
                               const std::optional<base::Location>& overrides_at = {});

// Reads a scene from a text: `path` names it in messages, and meshes are relative to its folder.
[[nodiscard]] Scene read_scene_text(std::string_view text, const std::filesystem::path& path,
                                    std::span<const std::string> overrides = {});

// A Scene with only the [[cctv]] tables and the [monitor] of a file. The file has nothing else, or
// is a complete scene (it has "format"), whose other tables are neither read nor checked. Throws as
// above.
[[nodiscard]] Scene read_camera_file(const std::filesystem::path& path);

}  // namespace earthshine::scenes
