// SPDX-License-Identifier: Apache-2.0
#include "app/cctv/camera_argument.h"

#include <vector>

#include "base/error.h"
#include "degrade/stage/read_setting.h"
#include "scenes/read/scene_file.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;
using degrade::did_you_mean;
using degrade::in_quotes;
using degrade::listed;

constexpr std::string_view suffix = ".toml";

struct Argument {
  std::string file;  // "": a camera that ships
  std::string name;  // "": the file's only one
};

Argument split(const std::string& argument) {
  if (const std::size_t at = argument.find(std::string(suffix) + ":"); at != std::string::npos) {
    const std::size_t end = at + suffix.size();
    return {argument.substr(0, end), argument.substr(end + 1)};
  }
  if (argument.ends_with(suffix)) return {argument, {}};
  return {{}, argument};
}

degrade::ResolvedCamera of_preset(std::string_view option, const std::string& name) {
  if (const degrade::Preset* preset = degrade::find_preset(name)) return degrade::resolve(*preset);
  const std::vector<std::string> names = degrade::preset_names();
  throw Error(Blame::Input, option, "there is no camera " + in_quotes(name),
              "it is " + listed(names) + ", FILE.toml or FILE.toml:NAME",
              did_you_mean(name, names));
}

}  // namespace

degrade::ResolvedCamera camera_of_argument(std::string_view option, const std::string& argument) {
  const auto [file, name] = split(argument);
  if (file.empty()) return of_preset(option, name);
  const scenes::Scene scene = scenes::read_camera_file(file);
  degrade::check_settings(scene);
  std::vector<std::string> names;
  for (const scenes::SettingTable& table : scene.cctv) names.push_back(table.name);
  if (names.empty()) {
    throw Error(Blame::Input, file, "has no [[cctv]]", {},
                "Add [[cctv]] with name = \"...\" or take a camera that ships");
  }
  if (name.empty() && names.size() == 1 && argument == file) {
    return degrade::resolve(scene, names.front());
  }
  for (const std::string& known : names) {
    if (known == name) return degrade::resolve(scene, name);
  }
  if (argument == file) {
    throw Error(Blame::Input, option,
                in_quotes(file) + " has " + std::to_string(names.size()) + " cameras",
                "they are " + listed(names), "Name one: " + file + ":" + names.front());
  }
  throw Error(Blame::Input, option, in_quotes(file) + " has no camera " + in_quotes(name),
              "it has " + listed(names), did_you_mean(name, names));
}

std::string file_of_camera(const std::string& argument) { return split(argument).file; }

}  // namespace earthshine::app
