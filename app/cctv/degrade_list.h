// SPDX-License-Identifier: Apache-2.0
// degrade --list and --describe: the cameras that ship, the stages, one camera in full.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/command.h"
#include "degrade/settings/camera_file.h"

namespace earthshine::app {

// All settings in use with unit and source, the noise in all forms, the monitor.
[[nodiscard]] Json camera_json(const degrade::ResolvedCamera& camera);
[[nodiscard]] std::string describe_camera(const degrade::ResolvedCamera& camera);

// Throws base::Error (Input) where the call names more beside `asked`, which makes no picture, than
// its `own` options and those of every command.
void refuse_beside(const std::string& asked, const CLI::App& degrade, std::vector<std::string> own);

void list_cameras(bool as_json);
void print_camera(const degrade::ResolvedCamera& camera, bool as_json);

// CAMERA as it is typed on the command line: one that ships, or one of a file.

// NAME of a camera that ships; FILE.toml, a camera file or a scene with one [[cctv]]; or
// FILE.toml:NAME. `option` is the place that messages name. Throws base::Error (Input): no such
// name (with the nearest), no or several [[cctv]] without a NAME (with their names), and whatever
// is wrong in the file.
[[nodiscard]] degrade::ResolvedCamera camera_of_argument(std::string_view option,
                                                         const std::string& argument);

// The file within the argument, "" when it is a camera that ships.
[[nodiscard]] std::string file_of_camera(const std::string& argument);

}  // namespace earthshine::app
