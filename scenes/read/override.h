// SPDX-License-Identifier: Apache-2.0
// "--set key=value": changes to a scene file's tree before it is read and checked.
#pragma once

#include <optional>
#include <string>

#include "scenes/text/toml_file.h"

namespace earthshine::scenes {

// "name=...", "quality.error=0.1" (a plain table, made if absent), "light.fwd.intensity=0" (the key
// after the last dot, of the entry of that name). The value is TOML; a word that is not is taken as
// a string. What is set carries the place "--set key=value", or asked_at where it
// stands in a file. Throws base::Error (Input) there if it
// cannot be applied.
void apply_override(TomlNode& root, const std::string& setting,
                    const std::optional<base::Location>& asked_at);

}  // namespace earthshine::scenes
