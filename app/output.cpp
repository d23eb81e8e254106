// SPDX-License-Identifier: Apache-2.0
#include "app/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>

#include "base/error.h"
#include "base/files/output_file.h"

namespace earthshine::app {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

namespace {

// Device and inode, so that links of both kinds count as their target; the name if the file does
// not exist. Empty for files that may be named twice, such as /dev/null.
std::string identity(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    return S_ISREG(status.st_mode) ? fmt::format("{}:{}", status.st_dev, status.st_ino) : "";
  }
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored).string();
}

}  // namespace

void check_outputs(const std::vector<std::string>& paths, const Files& inputs) {
  std::map<std::string, fs::path> read;
  for (const fs::path& input : inputs) {
    if (!input.empty()) read.emplace(identity(input), input);
  }
  std::set<std::string> written;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    const base::OutputFile checked(path);
    const std::string file = identity(path);
    if (file.empty()) continue;
    if (const auto input = read.find(file); input != read.end()) {
      const std::string also = input->second == path ? "" : ", as " + input->second.string() + ",";
      throw Error(Blame::Input, path, "is read" + also + " and would be overwritten", {},
                  "Name another file to write");
    }
    if (!written.insert(file).second) {
      throw Error(Blame::Input, path, "would be written twice", {}, "Give two names");
    }
  }
}

void refuse_other_kind(std::string_view option, const std::string& path,
                       const std::vector<std::string>& own) {
  constexpr std::array kinds = {".bin",  ".csv", ".exr", ".glb", ".gltf", ".h5",  ".html", ".ies",
                                ".json", ".mtl", ".obj", ".ply", ".png",  ".stl", ".toml"};
  const std::string ending = fs::path(path).extension().string();
  if (std::ranges::find(own, ending) != own.end()) return;
  if (std::ranges::find(kinds, ending) == kinds.end()) return;
  throw Error(Blame::Input, option, fmt::format("\"{}\" ends as another kind of file does", path),
              {}, fmt::format("Name a file that ends in {}", fmt::join(own, " or ")));
}

void make_folder(const fs::path& folder) {
  std::error_code problem, ignored;
  fs::create_directories(folder, problem);
  if (fs::is_directory(folder, ignored)) return;
  const std::string why = problem ? ": " + problem.message() : "";
  throw Error(problem ? base::blame_of_target(problem.value()) : Blame::Input, folder.string(),
              "cannot be made a folder" + why, {}, "Name another folder");
}

void prepare_folder(const std::string& folder, const std::vector<std::string>& files,
                    const Files& inputs) {
  make_folder(folder);
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
