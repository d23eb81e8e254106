// SPDX-License-Identifier: Apache-2.0
// Checks files and folders that will be written, before any work.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace earthshine::app {

using Files = std::vector<std::filesystem::path>;

// Throws base::Error before any work if one of the files (empty names are ignored) cannot be
// written, two are the same, or one is an input under any name: scenes::Scene::files has the inputs
// of a scene.
void check_outputs(const std::vector<std::string>& paths, const Files& inputs);

// Throws base::Error (Input) for a name with the extension of another kind of file: "bay.toml" for
// a solution. own: the valid extensions; names without an extension are valid.
void refuse_other_kind(std::string_view option, const std::string& path,
                       const std::vector<std::string>& own);

// Throws base::Error if the folder does not exist and cannot be made: base::blame_of_target().
void make_folder(const std::filesystem::path& folder);

// Makes the folder if necessary and checks that each of the files can be written in it, like
// check_outputs.
void prepare_folder(const std::string& folder, const std::vector<std::string>& files,
                    const Files& inputs);

// For a folder whose file names are not known in advance: throws base::Error (Input) if an input
// lies in it.
void refuse_inputs_in(const std::filesystem::path& folder, const Files& inputs);

// A camera's name as the start of a file name: letters, digits, '.', '-' and '_' stay, others
// become '_'. If two cameras get the same name, the later ones get their index in the scene.
[[nodiscard]] std::string file_stem(const scenes::Scene& scene, const scenes::Camera& camera);

}  // namespace earthshine::app
