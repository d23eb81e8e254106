// SPDX-License-Identifier: Apache-2.0
// "--set key=value": changes to a scene file's tree before it is read and checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/text/toml_file.h"

namespace earthshine::scenes {

struct LampOff {
  std::string name;
  base::Location where;
};

// Keys: "name=...", "quality.error=0.1" (a plain table, created if absent), "light.fwd.intensity=0"
// (the key after the last dot, in the entry with this name). The value is TOML; an unquoted word is
// a string. The place of the new value is "--set key=value", or asked_at if the setting is in a
// file. An intensity, flux or exitance of 0 switches off a light of any type, however its strength
// is given; a light that is in a mesh, not in the scene file, is added to `off`. Throws base::Error
// (Input) if the setting cannot be applied.
void apply_override(TomlNode& root, const std::string& setting,
                    const std::optional<base::Location>& asked_at, std::vector<LampOff>& off);

// Switches off lamps by name, when the scene is complete. Throws base::Error (Input) as
// apply_override does for unknown names.
void switch_off(Scene& scene, const std::vector<LampOff>& off);

}  // namespace earthshine::scenes
