// SPDX-License-Identifier: Apache-2.0
#include "app/command.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <set>

#include "app/build_id.h"
#include "app/console.h"
#include "base/error.h"
#include "base/ranks/ranks.h"
#include "degrade/range/range_sensor.h"
#include "degrade/settings/camera_file.h"
#include "radiosity/bodies/walls.h"
#include "raytrace/camera/camera.h"
#include "scenes/effects/quality.h"
#include "scenes/light/lamp_light.h"
#include "scenes/read/scene_file.h"
#include "scenes/text/message_text.h"

namespace earthshine::app {

using base::Blame;
using base::Error;

std::vector<std::string> part_free(const std::vector<std::string>& arguments) {
  const std::set<std::string> flags = {"-q", "--quiet", "--json"};
  const std::set<std::string> with_value = {"--part", "--wait", "-j", "--threads", "--max-memory"};
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    if (with_value.contains(word)) {
      ++k;
      continue;
    }
    const bool joined = with_value.contains(word.substr(0, word.find('='))) ||
                        (word.starts_with("-j") && !word.starts_with("--"));
    if (!flags.contains(word) && !joined) kept.push_back(word);
  }
  return kept;
}

std::string part_in(const std::vector<std::string>& arguments) {
  const std::string option = "--part";
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    if (word == option && k + 1 < arguments.size()) return arguments[k + 1];
    if (word.starts_with(option + "=")) return word.substr(option.size() + 1);
  }
  return "";
}

void check_ranks_alike(const Json& things) {
  base::Ranks* const ranks = base::ranks();
  if (ranks == nullptr) return;
  Json first;
  std::string differs;
  const auto compare = [&](int rank, const std::string& said) {
    const Json there = Json::parse(said);
    if (rank == 0) first = there;
    for (const auto& [name, thing] : first.items()) {
      if (!differs.empty() || (there.contains(name) && there[name] == thing)) continue;
      differs = fmt::format("{} is not what rank {} of {} has", name, rank, ranks->count());
    }
  };
  base::sequential_broadcast(
      *ranks, [&] { return dump(things); }, compare);
  if (differs.empty()) return;
  throw Error(Blame::Input, "rank 0", differs,
              "program, call and files must be the same on all machines of one run",
              "Copy them, or put them where all machines see them");
}

namespace {

// Squares of such small values underflow in float, and with them the stated errors.
void note_faint_light(const LoadedScene& loaded) {
  constexpr double faint = 1e-10;
  const scenes::Scene& scene = loaded.scene;
  double most = base::max_component(scene.ambient_radiance);
  for (const scenes::Lamp& lamp : scene.lamps) {
    most = std::max({most, base::max_component(scenes::lamp_flux_lm(lamp)),
                     base::max_component(lamp.illuminance_lx)});
  }
  for (const scenes::Material& material : scene.materials) {
    most = std::max(most, base::max_component(material.emit));
  }
  if (most <= 0.0 || most >= faint || loaded.effects.sun || loaded.effects.earth) return;
  note(
      fmt::format("warning: no light has more than {:.1e} lm, lm/m2 or cd/m2; below {:g} stated "
                  "errors may be too small; are the units right?",
                  most, faint));
}

}  // namespace

LoadedScene check_scene(scenes::Scene scene) {
  LoadedScene loaded;
  loaded.scene = std::move(scene);
  degrade::check_settings(loaded.scene);
  degrade::check_range_sensors(loaded.scene);
  return loaded;
}

void decide_effects(LoadedScene& loaded, const WantedEffects& wanted) {
  loaded.groups = scenes::find_light_groups(loaded.scene);
  loaded.asked = wanted.asked;
  loaded.effects = scenes::find_effects(loaded.scene, loaded.groups, loaded.asked);
  loaded.culled.clear();
  if (!wanted.culls) return;
  loaded.culled = scenes::cull_effects(
      loaded.scene, loaded.asked, loaded.scene.quality.error.value_or(scenes::default_error),
      radiosity::hidden_lights(loaded.scene, loaded.asked.cameras), loaded.groups, loaded.effects);
}

LoadedScene load(const SceneInput& input, bool quiet, const AskEffects& ask) {
  LoadedScene loaded =
      check_scene(scenes::read_scene(input.path, input.overrides, input.overrides_at));
  if (base::ranks() != nullptr) {
    Json read = Json::object({{"the program", build_id()}, {"its setting", input.overrides}});
    for (const auto& file : loaded.scene.files) read[file.string()] = digest_of_file(file);
    check_ranks_alike(read);
  }
  for (const std::string& warning : loaded.scene.warnings) {
    if (!quiet) note("warning: " + warning);
  }
  decide_effects(loaded, ask ? ask(loaded.scene) : WantedEffects{});
  if (!quiet) note_faint_light(loaded);
  return loaded;
}

scenes::RayQuery ray_query(LoadedScene& loaded, const scenes::SceneUse& use, bool quiet,
                           bool draws) {
  scenes::RayQuery query(loaded.scene);
  check_input(loaded, query, use, quiet, draws);
  return query;
}

void check_input(LoadedScene& loaded, const scenes::RayQuery& query, const scenes::SceneUse& use,
                 bool quiet, bool draws) {
  for (const scenes::Camera* camera : use.cameras) {
    if (draws) raytrace::check_camera(loaded.scene, query, *camera);
  }
  for (std::string& warning : scenes::implausible_input(loaded.scene, query, use)) {
    if (!quiet) note("warning: " + warning);
    loaded.scene.warnings.push_back(std::move(warning));
  }
}

std::vector<const scenes::Camera*> skip_hidden_cameras(const scenes::Scene& scene,
                                                       const scenes::RayQuery& query,
                                                       std::vector<const scenes::Camera*>& cameras,
                                                       bool quiet, const std::string& moment) {
  std::vector<const scenes::Camera*> hidden, seeing;
  std::vector<std::string> reasons;
  for (const scenes::Camera* camera : cameras) {
    try {
      raytrace::check_camera(scene, query, *camera);
      seeing.push_back(camera);
    } catch (const Error& error) {
      if (moment.empty() && hidden.size() + 1 == cameras.size()) throw;
      hidden.push_back(camera);
      reasons.emplace_back(error.what());
    }
  }
  for (const std::string& reason : reasons) {
    if (!quiet) note("skipped" + (moment.empty() ? "" : " at " + moment) + ": " + reason);
  }
  cameras = std::move(seeing);
  return hidden;
}

void check_skipped(const std::vector<std::string>& skipped) {
  if (skipped.empty()) return;
  throw StoppedShort("cameras inside a body were skipped: " + scenes::listed(skipped));
}

bool SceneInput::wants_error() const {
  return std::any_of(overrides.begin(), overrides.end(), [](const std::string& setting) {
    return setting.starts_with("quality.error=");
  });
}

const scenes::Camera& first_camera(const scenes::Scene& scene) {
  if (!scene.cameras.empty()) return scene.cameras.front();
  throw Error(Blame::Input, scene.path.string(), "has no camera", {}, "Add a [[camera]]");
}

const scenes::Camera& choose_camera(const scenes::Scene& scene, const std::string& name,
                                    const base::Location& named_at) {
  (void)first_camera(scene);
  std::vector<std::string> names;
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throw Error(
      Blame::Input, named_at, scene.path.string() + " has no camera " + scenes::in_quotes(name),
      fmt::format("its cameras are {}", fmt::join(names, ", ")), scenes::did_you_mean(name, names));
}

std::vector<const scenes::Camera*> each_once(std::vector<const scenes::Camera*> cameras) {
  for (auto camera = cameras.begin(); camera != cameras.end(); ++camera) {
    if (std::find(cameras.begin(), camera, *camera) == camera) continue;
    throw Error(Blame::Input, "--camera", "names " + (*camera)->name + " twice", {},
                "Name it once");
  }
  return cameras;
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

std::vector<std::string> limits_of_balance(const radiosity::Solution& solution, double enough) {
  const radiosity::BalanceReport& balance = solution.report.balance;
  std::vector<std::string> limits;
  std::string where;
  if (balance.worst < solution.patches.count()) {
    const std::uint32_t object = solution.patches.object(balance.worst);
    where = fmt::format(", {} at \"{}\"", balance.balanced ? "most" : "worst",
                        solution.report.objects.at(object).name);
  }
  if (balance.held > 0.001) {
    limits.push_back(
        fmt::format("so few form-factor rays that patches keep {:.1g} of their light for "
                    "themselves, as no other patch has room for it{}; raise "
                    "quality.form_factor_rays",
                    balance.held, balance.balanced ? where : ""));
  }
  // A smaller defect is invisible in results, however accurate the rest.
  constexpr double least_defect = 1e-6;
  if (balance.balanced || balance.sweeps == 0 || balance.after <= std::max(least_defect, enough)) {
    return limits;
  }
  limits.push_back(
      fmt::format("the form factors conserve energy to {:.1e} of the surface only, after "
                  "{} sweeps{}; raise quality.form_factor_rays to come nearer",
                  balance.after, balance.sweeps, where));
  return limits;
}

void note_balance(const radiosity::Solution& solution, double enough) {
  for (const std::string& limit : limits_of_balance(solution, enough)) note("warning: " + limit);
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
