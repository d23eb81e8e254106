// SPDX-License-Identifier: Apache-2.0
#include "app/visibility/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/study/study.h"
#include "app/views/sight_json.h"
#include "app/visibility/conditions.h"
#include "studies/error/error_budget.h"

namespace earthshine::app {
namespace {

constexpr const char* tasks[] = {"detect", "recognise", "identify"};

Json camera_json(const CameraResults& found) {
  const scenes::Camera& camera = *found.camera->camera;
  const bool cctv = found.camera->cctv.has_value();
  std::string iris;
  if (cctv) iris = degrade::word_of(found.camera->cctv->chain.camera.iris);
  return {{"scene", found.part->id},
          {"name", camera.name},
          {"columns", found.camera->columns},
          {"rows", found.camera->rows},
          {"fov_deg", camera.fov_deg},
          {"cctv", cctv ? Json(found.camera->cctv->name) : Json()},
          {"iris", cctv ? Json(iris) : Json()},
          {"relative_noise", found.relative_noise},
          {"error_text",
           fmt::format("noise of {:.2g} % in the picture of all lights together; the radiosity's "
                       "own error is that of the scene's quality settings",
                       100.0 * found.relative_noise)},
          {"render_seconds", found.render_seconds}};
}

// The largest stated error of any target's light by the Earth's cells, per condition.
void add_results(const CameraResults& found, std::map<std::string, double>& earth_error,
                 const Json& conditions, Json& results) {
  for (std::size_t k = 0; k < found.conditions.size(); ++k) {
    const std::string id = conditions[k]["id"];
    for (const Json& target : found.conditions[k]) {
      Json entry = {{"condition", id}, {"camera", found.camera->camera->name}};
      entry.update(target);
      if (!target["luminance_error"].is_null()) {
        double& worst = earth_error[id];
        worst = std::max(worst, target["luminance_error"].get<double>());
      }
      results.push_back(std::move(entry));
    }
  }
}

Json patches_of(const StudyFindings& findings, const StudyPart& part) {
  const auto found = findings.patches.find(part.id);
  return found == findings.patches.end() ? Json() : Json(found->second);
}

Json timeline_of(const CameraResults& found, const Json& conditions, std::size_t target,
                 std::size_t setting) {
  const std::size_t places = found.part->basis->places().size();
  Json line = {{"scene", found.part->id},
               {"camera", found.camera->camera->name},
               {"target", found.part->targets[target]},
               {"lamps", found.part->basis->settings()[setting].name}};
  for (const char* key : {"position_deg", "time_s", "sun_share"}) line[key] = Json::array();
  for (const char* task : tasks) line[task] = Json::array();
  line["luminance"] = line["weber"] = Json::array();
  for (std::size_t place = 0; place < places; ++place) {
    const std::size_t k = setting * places + place;
    const Json& condition = conditions[k];
    for (const char* key : {"position_deg", "time_s", "sun_share"}) {
      line[key].push_back(condition[key]);
    }
    const bool reached = !found.conditions[k].is_null();
    const Json entry = reached ? found.conditions[k][target] : Json();
    for (const char* task : tasks) {
      line[task].push_back(reached ? entry["probability"][task] : Json());
    }
    line["luminance"].push_back(reached ? entry["luminance"] : Json());
    line["weber"].push_back(reached ? entry["weber"] : Json());
  }
  return line;
}

Json settings_of(const StudyFindings& findings) {
  const studies::StudyFile& study = findings.study;
  Json set = Json::array();
  for (const std::string& override : study.overrides) set.push_back(override);
  Json lamps = Json::array();
  for (const studies::LampSetting& setting : study.lamps) lamps.push_back(setting.name);
  return {{"command", findings.command},
          {"set", set.dump()},
          {"lamp settings", lamps.dump()},
          {"positions", study.positions_deg.size()},
          {"seen from a probability of", study.seen_probability},
          {"cells of the Earth's disc", study.basis.disc_cells},
          {"cells of the sphere, where the Earth moves", study.basis.sphere_cells},
          {"seed", findings.seed}};
}

// What loading found, what the solution fell short of and what is not simulated.
void add_notes_of_scene(const StudyFindings& findings, const StudyPart& part, Json& notes) {
  const scenes::Scene& loaded = part.loaded.scene;
  const std::string scene = findings.parts.size() > 1 ? loaded.name + ": " : std::string();
  for (const std::string& warning : loaded.warnings) {
    notes.push_back(scene + "Found on loading: " + warning);
  }
  for (const Json& limit : findings.limits.value(part.id, Json::array())) {
    notes.push_back(scene + "Limit reached: " + limit.get<std::string>() + ".");
  }
  const studies::StudyScene of{part.basis_scene.scene, part.basis_scene.groups,
                               part.basis_scene.effects, *part.query};
  for (const std::string& missing : studies::not_captured(of, {})) {
    notes.push_back(scene + "Not simulated: " + missing + ".");
  }
}

Json notes_of(const StudyFindings& findings) {
  Json notes = Json::array();
  bool along = false, moving = false;
  for (const StudyPart* part : findings.parts) {
    const auto& earth = part->basis->scene().earth;
    along = along || part->basis->in_parts();
    moving = moving || (part->basis->in_parts() && earth && earth->half_angle_deg >= 180.0);
  }
  if (along) {
    notes.push_back(
        "Along the orbit the Earth's light is a sum over cells of even radiance; luminance_error "
        "is its likely size in each target's luminance, luminance_bound cannot be exceeded by it.");
    notes.push_back(
        "A partly hidden Sun counts as a whole one, dimmed; its penumbra has the width of "
        "the whole disc.");
  }
  if (moving) {
    notes.push_back(
        "The Earth moves through the sky of this attitude: its limb is drawn by cells of the "
        "sphere, coarse where a camera sees it directly or in a mirror.");
  }
  for (const StudyPart* part : findings.parts) add_notes_of_scene(findings, *part, notes);
  for (const CameraResults& found : findings.cameras) {
    notes.push_back(fmt::format(
        "Picture of camera {}: noise of {:.2g} % of the mean in the sum of all lights; the "
        "conditions' own noise is larger where little of that light shines.",
        found.camera->camera->name, 100.0 * found.relative_noise));
    const auto wanted = found.part->loaded.scene.quality.error;
    if (wanted && found.relative_noise > *wanted) {
      notes.push_back(fmt::format("Limit reached: the scene wants {:.2g} %.", 100.0 * *wanted));
    }
  }
  if (!findings.complete)
    notes.push_back("The study was stopped before its end; run it again to go on.");
  return notes;
}

}  // namespace

Json study_json(const StudyFindings& findings) {
  Json scenes = Json::array(), conditions = Json::array(), cameras = Json::array(),
       results = Json::array(), timelines = Json::array(), costs = Json::array();
  Json targets = Json::array();
  Json digests = Json::object();
  std::map<std::string, double> earth_error;
  for (const StudyPart* part : findings.parts) {
    scenes.push_back({{"id", part->id},
                      {"name", part->loaded.scene.name},
                      {"path", part->path},
                      {"patches", patches_of(findings, *part)}});
    digests[part->id] = scene_cache_key(part->loaded);
    for (const std::string& name : part->targets) {
      if (std::find(targets.begin(), targets.end(), Json(name)) == targets.end()) {
        targets.push_back(name);
      }
    }
    const Json of_part = conditions_json(*part);
    for (const CameraResults& found : findings.cameras) {
      if (found.part != part) continue;
      cameras.push_back(camera_json(found));
      add_results(found, earth_error, of_part, results);
      for (std::size_t t = 0; part->positions_deg.size() > 1 && t < part->targets.size(); ++t) {
        for (std::size_t s = 0; s < part->basis->settings().size(); ++s) {
          timelines.push_back(timeline_of(found, of_part, t, s));
        }
      }
    }
    for (const Json& condition : of_part) conditions.push_back(condition);
  }
  for (Json& condition : conditions) {
    const auto found = earth_error.find(condition["id"].get<std::string>());
    if (found != earth_error.end()) condition["earth_error"] = found->second;
  }
  Json notes = notes_of(findings);
  for (const std::string& note : black_back_notes(results)) notes.push_back(note);
  for (const StudyCost& cost : findings.costs) {
    costs.push_back({{"stage", cost.stage},
                     {"seconds", cost.seconds},
                     {"rays", cost.rays},
                     {"found", cost.found}});
  }
  return {{"format", 1},
          {"study", "visibility"},
          {"name", findings.study.name},
          {"version", EARTHSHINE_VERSION},
          {"complete", findings.complete},
          {"scenes", scenes},
          {"cameras", cameras},
          {"targets", targets},
          {"conditions", conditions},
          {"results", results},
          {"timelines", timelines},
          {"answers", findings.answers},
          {"pairs", findings.pairs},
          {"figures", findings.figures},
          {"thumbnails", findings.thumbnails},
          {"settings", settings_of(findings)},
          {"provenance",
           {{"program", std::string("earthshine ") + EARTHSHINE_VERSION},
            {"compiler", __VERSION__},
            {"seed", findings.seed},
            {"scene_digest", digests.dump()}}},
          {"costs", costs},
          {"notes", notes}};
}

std::string study_csv(const Json& study) {
  std::map<std::string, const Json*> conditions;
  for (const Json& condition : study["conditions"]) {
    conditions[condition["id"].get<std::string>()] = &condition;
  }
  Json rows = Json::array();
  for (const Json& result : study["results"]) {
    rows.push_back(flat_row(*conditions.at(result["condition"].get<std::string>()), result));
  }
  return csv_of(rows);
}

std::string study_text(const Json& study) {
  std::map<std::string, const Json*> conditions;
  for (const Json& condition : study["conditions"]) {
    conditions[condition["id"].get<std::string>()] = &condition;
  }
  // How often each verdict was given, in the order of the results.
  struct Line {
    std::string camera, target, lamps, why;
    std::vector<std::pair<std::string, int>> verdicts;
    double best = -1.0, worst = 2.0;
    int count = 0;
  };
  std::vector<Line> lines;
  for (const Json& result : study["results"]) {
    const Json& condition = *conditions.at(result["condition"].get<std::string>());
    const std::string scene = condition["scene"], name = result["camera"];
    const std::string camera = study["scenes"].size() > 1 ? scene + " " + name : name;
    const std::string target = result["target"], lamps = condition["lamps"],
                      verdict = result["verdict"];
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
      return l.camera == camera && l.target == target && l.lamps == lamps;
    });
    if (line == lines.end()) line = lines.insert(lines.end(), {camera, target, lamps, {}, {}});
    ++line->count;
    auto counted = std::find_if(line->verdicts.begin(), line->verdicts.end(),
                                [&](const auto& v) { return v.first == verdict; });
    if (counted == line->verdicts.end()) {
      line->verdicts.emplace_back(verdict, 1);
    } else {
      ++counted->second;
    }
    const Json& detect = result["probability"]["detect"];
    const double p = detect.is_null() ? 0.0 : detect.get<double>();
    line->best = std::max(line->best, p);
    if (p >= line->worst) continue;
    line->worst = p;
    line->why = result["why"];
  }
  std::string text = fmt::format("{:<10} {:<20} {:<16} {:>13}  {}\n", "camera", "target", "lamps",
                                 "P(detect)", "verdicts; why not better, at worst");
  for (const Line& line : lines) {
    std::string verdicts;
    for (const auto& [verdict, count] : line.verdicts) {
      verdicts += fmt::format("{}{}{}", verdicts.empty() ? "" : ", ", verdict,
                              line.count > 1 ? fmt::format(" x{}", count) : "");
    }
    const std::string range = line.best - line.worst < 0.005
                                  ? fmt::format("{:.2f}", line.best)
                                  : fmt::format("{:.2f} to {:.2f}", line.worst, line.best);
    text += fmt::format("{:<10} {:<20} {:<16} {:>13}  {}{}\n", line.camera, line.target, line.lamps,
                        range, verdicts, line.why.empty() ? "" : "; " + line.why);
  }
  if (lines.empty()) text = "No object is a target: nothing was judged.\n";
  for (const Json& answer : study["answers"]) {
    text += fmt::format("{}: {}\n", answer["wanted"].get<std::string>(),
                        answer["text"].get<std::string>());
  }
  for (const std::string& note : black_back_notes(study["results"])) text += note + "\n";
  return text;
}

}  // namespace earthshine::app
