// SPDX-License-Identifier: Apache-2.0
// degrade --list and --describe: the cameras that ship, the stages, one camera in full.
#pragma once

#include <string>

#include "app/command.h"
#include "degrade/settings/camera_file.h"

namespace earthshine::app {

// All settings in use with unit and source, the noise in all forms, the monitor.
[[nodiscard]] Json camera_json(const degrade::ResolvedCamera& camera);
[[nodiscard]] std::string describe_camera(const degrade::ResolvedCamera& camera);

void list_cameras(bool as_json);
void print_camera(const degrade::ResolvedCamera& camera, bool as_json);

}  // namespace earthshine::app
