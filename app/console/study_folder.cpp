// SPDX-License-Identifier: Apache-2.0
#include "app/console/study_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "app/output.h"
#include "app/parts/result_cache.h"
#include "app/report/page.h"
#include "app/visibility/conditions.h"
#include "base/error.h"
#include "radiosity/store/solution_key.h"

namespace earthshine::app {
namespace {

using base::Blame;
using base::Error;
namespace fs = std::filesystem;

constexpr std::string_view run_command = "study run ";

std::string setting_text(const StudyResults& results, const char* key) {
  const auto found = results.settings.find(key);
  return found != results.settings.end() && found->is_string() ? found->get<std::string>() : "";
}

// The study of `study visibility` and `study orbit`, from its results.
studies::StudyFile study_of_results(const StudyResults& results) {
  studies::StudyFile study;
  study.name = results.name;
  study.lamps = {studies::lamps_as_they_are()};
  for (const SceneEntry& scene : results.scenes) study.scenes.emplace_back(scene.path);
  const Json set = Json::parse(setting_text(results, "set"), nullptr, false);
  for (const Json& override : set) {
    if (override.is_string()) study.overrides.push_back(override.get<std::string>());
  }
  const auto same_size = [&](const CameraEntry& camera) {
    return camera.columns == results.cameras.front().columns &&
           camera.rows == results.cameras.front().rows;
  };
  if (!results.cameras.empty() && std::ranges::all_of(results.cameras, same_size)) {
    study.columns = results.cameras.front().columns;
    study.rows = results.cameras.front().rows;
  }
  for (const CameraEntry& camera : results.cameras) study.cameras.push_back(camera.name);
  for (const ConditionEntry& condition : results.conditions) {
    study.usual_positions = study.usual_positions || !condition.utc.empty();
    if (condition.position_deg) study.positions_deg.push_back(*condition.position_deg);
  }
  // `study visibility` has the scene's own position.
  if (setting_text(results, "command") == "study visibility") study.positions_deg.clear();
  return study;
}

std::size_t number_of_condition(const StudyResults& results, const std::string& id) {
  const auto found = std::ranges::find(results.conditions, id, &ConditionEntry::id);
  if (found == results.conditions.end()) {
    throw Error(Blame::Input, study_file, "has no condition " + id, {}, "Run the study again");
  }
  return static_cast<std::size_t>(found - results.conditions.begin());
}

Json factors_json(const StudyPart& part, std::size_t setting) {
  const studies::LightBasis& basis = *part.basis;
  const std::vector<Rgb> weights = basis.weights(0, setting).weight;
  Json factors = Json::array();
  for (const ConsoleLight& light : console_lights(part)) {
    Rgb factor(1.0);
    if (light.kind == "sun" || light.kind == "earth") {
      const auto& named = basis.settings()[setting].factors;
      if (const auto found = named.find(light.name); found != named.end()) factor = found->second;
    } else if (light.kind != "ambient") {
      const auto& names = basis.groups().names;
      factor =
          weights[static_cast<std::size_t>(std::ranges::find(names, light.name) - names.begin())];
    }
    factors.push_back({factor.r, factor.g, factor.b});
  }
  return factors;
}

}  // namespace

bool is_study_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

FinishedStudy finished_study(const std::string& folder, const std::vector<std::string>& cameras) {
  FinishedStudy finished{folder, read_study(folder), {}, 1};
  const StudyResults& results = finished.results;
  if (!results.complete || results.conditions.empty()) {
    throw Error(Blame::Input, (fs::path(folder) / study_file).string(), "is not complete", {},
                "Run the study's command again, which goes on with it");
  }
  const std::string command = setting_text(results, "command");
  if (command.starts_with(run_command)) {
    finished.study = studies::read_study_file(command.substr(run_command.size()));
  } else {
    finished.study = study_of_results(results);
  }
  const auto seed = results.settings.find("seed");
  if (seed == results.settings.end() || !seed->is_number_unsigned()) {
    throw Error(Blame::Input, (fs::path(folder) / study_file).string(), "has no seed", {},
                "Run the study again");
  }
  finished.seed = seed->get<std::uint64_t>();
  if (!cameras.empty()) finished.study.cameras = cameras;
  return finished;
}

void check_unchanged(const FinishedStudy& finished, const StudyPart& part) {
  const auto& provenance = finished.results.provenance;
  const auto text = provenance.find("scene_digest");
  const Json digests = text != provenance.end() && text->is_string()
                           ? Json::parse(text->get<std::string>(), nullptr, false)
                           : Json();
  const auto of_part = digests.find(part.id);
  const Json before = digests.is_object() && of_part != digests.end() && of_part->is_object()
                          ? *of_part
                          : Json::object();
  const Json now = scene_cache_key(part.loaded);
  std::vector<std::string> changed;
  for (const auto& piece : radiosity::scene_parts(part.loaded.scene, part.loaded.groups)) {
    if (before.value(piece.key, Json()) != now[piece.key]) changed.push_back(piece.words);
  }
  if (changed.empty() && before.value("lobes", Json()) != now["lobes"]) {
    changed.emplace_back("the materials");
  }
  const Json cameras = before.value("cameras", Json());
  for (const StudyCamera& camera : part.cameras) {
    const Json key = camera_digest(camera);
    const auto found = cameras.find(camera.camera->name);
    if (found != cameras.end() && *found == key) continue;
    changed.push_back("camera " + camera.camera->name);
  }
  if (changed.empty()) return;
  throw Error(Blame::Input, part.path,
              fmt::format("has changed since the study in {}: {}", finished.folder,
                          fmt::join(changed, ", ")),
              {}, "Run the study again, or make the console of the scene: console " + part.path);
}

Json study_json(const FinishedStudy& finished, const StudyPart& part) {
  const StudyResults& results = finished.results;
  const std::size_t places = part.basis->places().size();
  const std::vector<ConditionEntry> conditions = conditions_of(part);
  Json settings = Json::array();
  for (std::size_t s = 0; s < part.basis->settings().size(); ++s) {
    settings.push_back(
        {{"name", part.basis->settings()[s].name}, {"factors", factors_json(part, s)}});
  }
  // By camera and target: a list of [verdict, reasons] with the places of the first setting first.
  Json judged = Json::object();
  std::map<std::size_t, std::size_t> part_of;  // number in the results: in the part
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    part_of[number_of_condition(results, conditions[k].id)] = k;
  }
  for (const ResultEntry& result : results.results) {
    const auto condition = part_of.find(result.condition);
    if (condition == part_of.end()) continue;
    Json& list = judged[results.cameras[result.camera].name][results.targets[result.target]];
    if (list.is_null()) list = Json::array_t(conditions.size());
    list[condition->second] = {std::string(studies::word_of(result.sight.verdict)), result.why};
  }
  return {
      {"folder", finished.folder}, {"places", places}, {"settings", settings}, {"judged", judged}};
}

}  // namespace earthshine::app
