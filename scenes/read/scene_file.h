// SPDX-License-Identifier: Apache-2.0
// TOML scene file to Scene (docs/scene-format.md). toml_file.cpp is the only user of toml++.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace earthshine::scenes {

// Reads a scene and the meshes it names. Each override is "key=value" with a dotted path and a TOML
// value: "quality.gather_rays=64", "sun.illuminance=0", "light.fwd-bulkhead.intensity=0" (the entry
// of that name), "camera.A.fov_deg=30". Overrides are checked like the file's own keys; one that
// creates a table or entry that the file does not have is allowed for the plain tables (sun, earth,
// orbit, ambient, quality, monitor) and refused for named entries. overrides_at: where they stand
// in a file, for messages; none: they are --set of the command line. Throws base::Error (Input):
// where (file:line:column), what was found, what is allowed, what to do.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path,
                               std::span<const std::string> overrides = {},
                               const std::optional<base::Location>& overrides_at = {});

// The same of a text that stands in no file: `path` names it in messages, and the meshes are looked
// for in its folder.
[[nodiscard]] Scene read_scene_text(std::string_view text, const std::filesystem::path& path,
                                    std::span<const std::string> overrides = {});

// A Scene with nothing but the [[cctv]] tables and the [monitor] of the file, which holds nothing
// else or is a whole scene (it has "format"), whose other tables are neither read nor checked.
// Throws as above.
[[nodiscard]] Scene read_camera_file(const std::filesystem::path& path);

}  // namespace earthshine::scenes
