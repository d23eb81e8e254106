// SPDX-License-Identifier: Apache-2.0
// CAMERA as it is typed on the command line: one that ships, or one of a file.
#pragma once

#include <string>
#include <string_view>

#include "degrade/settings/camera_file.h"

namespace earthshine::app {

// NAME of a camera that ships; FILE.toml, a camera file or a scene with one [[cctv]]; or
// FILE.toml:NAME. `option` is the place that messages name. Throws base::Error (Input): no such
// name (with the nearest), no or several [[cctv]] without a NAME (with their names), and whatever
// is wrong in the file.
[[nodiscard]] degrade::ResolvedCamera camera_of_argument(std::string_view option,
                                                         const std::string& argument);

// The file within the argument, "" when it is a camera that ships.
[[nodiscard]] std::string file_of_camera(const std::string& argument);

}  // namespace earthshine::app
