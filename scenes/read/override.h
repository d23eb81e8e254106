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

// "name=...", "quality.error=0.1" (a plain table, made if absent), "light.fwd.intensity=0" (the key
// after the last dot, of the entry of that name). The value is TOML; a word that is not is taken as
// a string. What is set carries the place "--set key=value", or asked_at where it
// stands in a file. An intensity, flux or exitance of 0 turns off a light of any type, however its
// strength is given; a light that is not in the scene file but in a mesh goes to `off`. Throws
// base::Error (Input) there if it cannot be applied.
void apply_override(TomlNode& root, const std::string& setting,
                    const std::optional<base::Location>& asked_at, std::vector<LampOff>& off);

// Turns off lamps by their names, when all are in the scene. Throws base::Error (Input) as
// apply_override does for names that no lamp has.
void turn_off(Scene& scene, const std::vector<LampOff>& off);

}  // namespace earthshine::scenes
