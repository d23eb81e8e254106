// SPDX-License-Identifier: Apache-2.0
// Names of files and folders that will be written, looked at before any work is done.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::app {

using Files = std::vector<std::filesystem::path>;

// Throws base::Error before any work is done if one of the files (empty names are left out) cannot
// be written, two are the same, or one is an input, under whatever name: scenes::Scene::files has
// those of a scene.
void check_outputs(const std::vector<std::string>& paths, const Files& inputs);

// Throws base::Error (Input) for a name that ends as files of another kind do, which are others'
// work: "bay.toml" for a solution. own: the endings to choose from; names without one are fine.
void refuse_other_kind(std::string_view option, const std::string& path,
                       const std::vector<std::string>& own);

// Throws base::Error where there is no folder and none can be made: base::blame_of_target().
void make_folder(const std::filesystem::path& folder);

// Makes the folder where there is none and sees that each of the files can be written in it, as
// check_outputs does.
void prepare_folder(const std::string& folder, const std::vector<std::string>& files,
                    const Files& inputs);

// For a folder whose files get their names as they come: throws base::Error (Input) where an input
// lies in it.
void refuse_inputs_in(const std::filesystem::path& folder, const Files& inputs);

// A camera's name as the start of a file name: letters, digits, '.', '-' and '_' stay, others
// become '_'. Where two cameras would meet, the later ones get their number in the scene.
[[nodiscard]] std::string file_stem(const scenes::Scene& scene, const scenes::Camera& camera);

}  // namespace earthshine::app
