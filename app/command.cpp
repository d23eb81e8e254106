// SPDX-License-Identifier: Apache-2.0
#include "app/command.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "app/console.h"
#include "base/error.h"
#include "degrade/range/range_sensor.h"
#include "degrade/settings/camera_file.h"
#include "scenes/read/scene_file.h"

namespace earthshine::app {

using base::Blame;
using base::Error;

LoadedScene load(const SceneInput& input, bool quiet) {
  LoadedScene loaded;
  loaded.scene = scenes::read_scene(input.path, input.overrides, input.overrides_at);
  degrade::check_settings(loaded.scene);
  degrade::check_range_sensors(loaded.scene);
  loaded.groups = scenes::find_light_groups(loaded.scene);
  loaded.effects = scenes::find_effects(loaded.scene, loaded.groups);
  for (const std::string& warning : loaded.scene.warnings) {
    if (!quiet) note("warning: " + warning);
  }
  return loaded;
}

bool SceneInput::wants_error() const {
  return std::any_of(overrides.begin(), overrides.end(), [](const std::string& setting) {
    return setting.starts_with("quality.error=");
  });
}

const scenes::Camera& choose_camera(const scenes::Scene& scene, const std::string& name) {
  if (scene.cameras.empty()) {
    throw Error(Blame::Input, scene.path.string(), "has no camera", {}, "Add a [[camera]]");
  }
  if (name.empty()) return scene.cameras.front();
  std::vector<std::string> names;
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throw Error(Blame::Input, scene.path.string(), "has no camera \"" + name + "\"",
              fmt::format("its cameras are {}", fmt::join(names, ", ")));
}

double StageTimes::total() const {
  double sum = 0.0;
  for (const Stage& stage : stages_) sum += stage.second;
  return sum;
}

void StageTimes::add(const std::string& name, double seconds) {
  for (Stage& stage : stages_) {
    if (stage.first != name) continue;
    stage.second += seconds;
    return;
  }
  stages_.emplace_back(name, seconds);
}

Json StageTimes::json() const {
  Json json = Json::object();
  for (const auto& [stage, seconds] : stages_) json[stage] = seconds;
  return json;
}

double peak_memory_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts KiB
}

std::vector<std::string> limits_of_balance(const radiosity::Solution& solution) {
  const radiosity::BalanceReport& balance = solution.report.balance;
  std::vector<std::string> limits;
  if (balance.held > 0.001) {
    limits.push_back(
        fmt::format("so few form-factor rays that patches keep {:.1g} of their light for "
                    "themselves, as no other patch has room for it; raise quality.form_factor_rays",
                    balance.held));
  }
  if (balance.balanced || balance.sweeps == 0) return limits;
  std::string where;
  if (balance.worst < solution.patches.count()) {
    const std::uint32_t object = solution.patches.object(balance.worst);
    where = fmt::format(", worst at \"{}\"", solution.report.objects.at(object).name);
  }
  limits.push_back(
      fmt::format("the form factors conserve energy to {:.1e} of the surface only, after "
                  "{} sweeps{}; raise quality.form_factor_rays to come nearer",
                  balance.after, balance.sweeps, where));
  return limits;
}

void note_balance(const radiosity::Solution& solution) {
  for (const std::string& limit : limits_of_balance(solution)) note("warning: " + limit);
}

void note_backs(const radiosity::SolveReport& report) {
  for (const radiosity::ObjectLight& object : report.objects) {
    if (object.back_share < 0.5) continue;
    note(fmt::format(
        "warning: {:.0f} % of the rays that met \"{}\" met its back, which is black; turn "
        "its faces over, or make its material two_sided",
        100.0 * object.back_share, object.name));
  }
}

}  // namespace earthshine::app
