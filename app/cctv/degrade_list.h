// SPDX-License-Identifier: Apache-2.0
// degrade --list and --describe: built-in cameras, stages, full description of one camera.
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

// For `asked`, an option without a picture: throws base::Error (Input) if the call has other
// options than its `own` and the common ones.
void refuse_beside(const std::string& asked, const CLI::App& degrade, std::vector<std::string> own);

void list_cameras(bool as_json);
void print_camera(const degrade::ResolvedCamera& camera, bool as_json);

// CAMERA on the command line: a built-in camera, or one of a file.

// NAME of a built-in camera; FILE.toml, a camera file or a scene with one [[cctv]]; or
// FILE.toml:NAME. `option` is the place for messages. Throws base::Error (Input) for an unknown
// name (with the nearest), for no or several [[cctv]] without a NAME (with their names), and for
// errors in the file.
[[nodiscard]] degrade::ResolvedCamera camera_of_argument(std::string_view option,
                                                         const std::string& argument);

// The file of the argument, "" for a built-in camera.
[[nodiscard]] std::string file_of_camera(const std::string& argument);

}  // namespace earthshine::app
