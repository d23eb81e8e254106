// SPDX-License-Identifier: Apache-2.0
// Names of files and folders that will be written, looked at before any work is done.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::app {

// Throws base::Error before any work is done if one of the files (empty names are left out) cannot
// be written or two are the same.
void check_outputs(const std::vector<std::string>& paths, const std::vector<std::string>& inputs);

// Makes the folder where there is none and sees that each of the files can be written in it.
// Throws base::Error before any work is done.
void prepare_folder(const std::string& folder, const std::vector<std::string>& files);

// A camera's name as the start of a file name: letters, digits, '.', '-' and '_' stay, others
// become '_'. Where two cameras would meet, the later ones get their number in the scene.
[[nodiscard]] std::string file_stem(const scenes::Scene& scene, const scenes::Camera& camera);

}  // namespace earthshine::app
