// SPDX-License-Identifier: Apache-2.0
#include "app/output.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files/output_file.h"

namespace earthshine::app {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

namespace {

// By device and inode, so that links of both kinds count as what they lead to.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  if (fs::exists(a, ignored)) {
    const bool plain = fs::is_regular_file(a, ignored);  // not /dev/null, which may be named twice
    return plain && fs::equivalent(a, b, ignored);
  }
  return fs::weakly_canonical(fs::absolute(a, ignored), ignored) ==
         fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

}  // namespace

void check_outputs(const std::vector<std::string>& paths, const Files& inputs) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) continue;
    const base::OutputFile checked(paths[i]);
    for (const fs::path& input : inputs) {
      if (input.empty() || !is_same_file(paths[i], input)) continue;
      const std::string also = input == paths[i] ? "" : ", as " + input.string() + ",";
      throw Error(Blame::Input, paths[i], "is read" + also + " and would be overwritten", {},
                  "Name another file to write");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!paths[j].empty() && is_same_file(paths[i], paths[j])) {
        throw Error(Blame::Input, paths[i], "would be written twice", {}, "Give two names");
      }
    }
  }
}

void prepare_folder(const std::string& folder, const std::vector<std::string>& files,
                    const Files& inputs) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!fs::is_directory(folder)) {
    const std::string why = problem ? ": " + problem.message() : "";
    throw Error(Blame::Input, folder, "cannot be made a folder" + why, {}, "Name another folder");
  }
  std::vector<std::string> paths;
  paths.reserve(files.size());
  for (const std::string& file : files) paths.push_back((fs::path(folder) / file).string());
  check_outputs(paths, inputs);
}

void refuse_inputs_in(const fs::path& folder, const Files& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    const fs::path own = fs::weakly_canonical(fs::absolute(input, ignored), ignored).parent_path();
    if (input.empty() || !fs::equivalent(own, folder, ignored)) continue;
    throw Error(Blame::Input, folder.string(), "holds " + input.string() + ", which is read",
                "files in it may be overwritten", "Name another folder");
  }
}

std::string file_stem(const scenes::Scene& scene, const scenes::Camera& camera) {
  const auto plain = [](const std::string& name) {
    std::string stem = name;
    for (char& c : stem) {
      const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                        (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
      if (!kept) c = '_';
    }
    return stem;
  };
  std::string stem = plain(camera.name);
  for (const scenes::Camera& earlier : scene.cameras) {
    if (&earlier == &camera) break;
    if (plain(earlier.name) == stem) {
      return fmt::format("{}-{}", stem, &camera - scene.cameras.data() + 1);
    }
  }
  return stem;
}

}  // namespace earthshine::app
