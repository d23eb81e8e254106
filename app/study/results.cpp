// SPDX-License-Identifier: Apache-2.0
#include "app/study/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "app/study/json_fields.h"
#include "app/study/words.h"

namespace earthshine::app {
namespace {

using studies::MonitorSight, studies::Probability, studies::Sight, studies::SignalSight;

template <Figure Of>
Json cell_of(const TargetFindings& found) {
  return to_json(Of(found));
}

struct CsvColumn {
  const char* name;
  Json (*of)(const TargetFindings&);
};
// Columns after those of the condition, the camera and the target.
constexpr CsvColumn csv_columns[] = {
    {"verdict",
     [](const TargetFindings& f) { return Json(std::string(word_of(f.sight.verdict))); }},
    {"detect", cell_of<chance_of<&Probability::detect>>},
    {"recognise", cell_of<chance_of<&Probability::recognise>>},
    {"identify", cell_of<chance_of<&Probability::identify>>},
    {"pixels", [](const TargetFindings& f) { return Json(f.sight.pixels); }},
    {"visible_fraction", cell_of<sight_of<&Sight::visible_fraction>>},
    {"cut_by_frame", [](const TargetFindings& f) { return Json(f.sight.cut_by_frame); }},
    {"lit_fraction", cell_of<figure_of<&TargetFindings::lit_fraction>>},
    {"angle_deg", cell_of<sight_of<&Sight::angle_deg>>},
    {"tv_lines", cell_of<sight_of<&Sight::tv_lines>>},
    {"luminance", cell_of<sight_of<&Sight::luminance>>},
    {"surround", cell_of<sight_of<&Sight::surround>>},
    {"weber", cell_of<sight_of<&Sight::weber>>},
    {"johnson_cycles", cell_of<sight_of<&Sight::johnson_cycles>>},
    {"saturated", cell_of<sight_of<&Sight::saturated>>},
    {"crushed", cell_of<sight_of<&Sight::crushed>>},
    {"shown_from", cell_of<sight_of<&Sight::shown_from>>},
    {"shown_to", cell_of<sight_of<&Sight::shown_to>>},
    {"luminance_error", cell_of<figure_of<&TargetFindings::luminance_error>>},
    {"picture_noise", cell_of<noise_of<&studies::ConditionNoise::relative>>},
    {"black_back", cell_of<sight_of<&Sight::black_back>>},
    {"signal_mean", cell_of<signal_of<&SignalSight::mean>>},
    {"signal_weber", cell_of<signal_of<&SignalSight::weber>>},
    {"signal_snr", cell_of<signal_of<&SignalSight::snr>>},
    {"signal_cnr", cell_of<signal_of<&SignalSight::cnr>>},
    {"signal_rose", cell_of<signal_of<&SignalSight::rose>>},
    {"signal_snr_d", cell_of<signal_of<&SignalSight::snr_d>>},
    {"signal_dprime", cell_of<signal_of<&SignalSight::dprime>>},
    {"monitor_luminance", cell_of<monitor_of<&MonitorSight::luminance>>},
    {"monitor_weber", cell_of<monitor_of<&MonitorSight::weber>>},
    {"eye_detect", cell_of<eye_chance_of<&Probability::detect>>},
    {"why", [](const TargetFindings& f) { return Json(f.why); }},
    {"picture_noise_cd_m2", cell_of<noise_of<&studies::ConditionNoise::cd_m2>>},
    {"finished_by",
     [](const TargetFindings& f) { return Json(studies::word_of(f.noise.finished_by)); }},
};

// A line of the text output.
struct Line {
  std::string scene, camera, target, lamps, why;           // why: in the worst case
  std::vector<std::pair<studies::Verdict, int>> verdicts;  // counts, in the results' order
  double best = -1.0, worst = 2.0;
  int count = 0;
};

std::vector<Line> lines_of(const StudyResults& study) {
  std::vector<Line> lines;
  for (const ResultEntry& result : study.results) {
    const ConditionEntry& condition = study.conditions[result.condition];
    const std::string& camera = study.cameras[result.camera].name;
    const std::string scene = study.scenes.size() > 1 ? scene_title(study, condition.scene) : "";
    const std::string& target = study.targets[result.target];
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
      return l.scene == scene && l.camera == camera && l.target == target &&
             l.lamps == condition.lamps;
    });
    if (line == lines.end()) {
      line = lines.insert(lines.end(), {scene, camera, target, condition.lamps, {}, {}});
    }
    ++line->count;
    const studies::Verdict verdict = result.sight.verdict;
    auto counted = std::find_if(line->verdicts.begin(), line->verdicts.end(),
                                [&](const auto& v) { return v.first == verdict; });
    if (counted == line->verdicts.end()) {
      line->verdicts.emplace_back(verdict, 1);
    } else {
      ++counted->second;
    }
    const double p = result.sight.probability ? result.sight.probability->detect : 0.0;
    line->best = std::max(line->best, p);
    if (p >= line->worst) continue;
    line->worst = p;
    line->why.clear();
    if (result.why.empty()) continue;
    if (condition.position_deg) line->why = fmt::format("at {:g} deg: ", *condition.position_deg);
    const std::string figure = deciding_figure(result);
    line->why += figure + (figure.empty() ? "" : "; ") + result.why;
  }
  return lines;
}

}  // namespace

void EntryNames::add(const JsonPart& part, Named what, const char* key, const std::string& name,
                     std::size_t scene) {
  if (!places_.emplace(std::tuple(what, scene, name), counts_[what]++).second) {
    part.refuse(key, "\"" + name + "\" once more", "each is there once");
  }
}

std::size_t EntryNames::find(const JsonPart& part, Named what, const char* key,
                             std::size_t scene) const {
  constexpr const char* lists[] = {"scenes", "cameras of that scene", "targets", "conditions"};
  const std::string name = part.needed_text(key);
  const auto found = places_.find(std::tuple(what, scene, name));
  if (found != places_.end()) return found->second;
  part.refuse(key, "\"" + name + "\"",
              std::string("it is one of the study's ") + lists[static_cast<std::size_t>(what)]);
}

void JsonReader::one_of(const char* key, std::string& text,
                        std::initializer_list<const char*> words) {
  text = part_.text(key);
  if (text.empty() || std::find(words.begin(), words.end(), text) != words.end()) return;
  std::string known;
  for (const char* word : words) known += std::string(word) + ", ";
  part_.refuse(key, "\"" + text + "\"", "it is " + known + "or null");
}

void JsonReader::factors(const char* key, std::vector<Factor>& factors) {
  const JsonPart object = part_.object(key);
  for (const auto& [group, value] : object.json().items()) {
    if (!value.is_array()) {
      factors.push_back({group, Rgb(object.number(group.c_str()).value_or(NAN))});
      continue;
    }
    const std::vector<Number> rgb = object.numbers(group.c_str());
    if (rgb.size() != 3) object.refuse(group, "not a colour", "it is [red, green, blue]");
    factors.push_back({group, {rgb[0].value_or(NAN), rgb[1].value_or(NAN), rgb[2].value_or(NAN)}});
  }
}

const std::string& name_of(const StudyResults& study, Named what, std::size_t number) {
  switch (what) {
    case Named::Scene:
      return study.scenes[number].id;
    case Named::Camera:
      return study.cameras[number].name;
    case Named::Target:
      return study.targets[number];
    case Named::Condition:
      break;
  }
  return study.conditions[number].id;
}

namespace {

// Checks that involve several entries.
void check_together(const JsonPart& top, const StudyResults& study) {
  std::set<std::tuple<std::size_t, std::size_t, std::size_t>> seen;
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    const ResultEntry& result = study.results[k];
    if (seen.insert({result.condition, result.camera, result.target}).second) continue;
    top.refuse(fmt::format("results[{}]", k), "there once more",
               "each condition, camera and target has one result");
  }
}

// Copies reasons that were found in another condition.
void take_reasons_over(StudyResults& study) {
  std::map<std::tuple<std::string, std::size_t, std::size_t>, std::size_t> own;
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    const ResultEntry& result = study.results[k];
    if (!result.why_of.empty()) continue;
    own[{study.conditions[result.condition].id, result.camera, result.target}] = k;
  }
  for (ResultEntry& result : study.results) {
    const auto found = own.find({result.why_of, result.camera, result.target});
    if (result.why_of.empty() || found == own.end()) continue;
    result.why = study.results[found->second].why;
    result.reasons = study.results[found->second].reasons;
  }
}

}  // namespace

Json with_four_digits(double value) {
  if (!std::isfinite(value)) return nullptr;
  const double rounded = std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr);
  // Integers without the ".0" of floating-point numbers.
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) {
    return static_cast<std::int64_t>(rounded);
  }
  return rounded;
}

std::vector<Json> objects_of_rows(const JsonPart& table) {
  std::vector<std::string> columns;
  for (const JsonPart& column : table.needed_list("columns")) columns.push_back(column.as_text());
  std::vector<Json> objects;
  for (const JsonPart& row : table.needed_list("rows")) {
    const Json& cells = row.json();
    if (!cells.is_array() || cells.size() != columns.size()) {
      row.refuse("", "no row of the table", fmt::format("a list of {} cells", columns.size()));
    }
    Json& object = objects.emplace_back(Json::object());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (cells[k].is_null()) continue;
      Json* place = &object;
      std::string_view path = columns[k];
      for (std::size_t dot; (dot = path.find('.')) != std::string_view::npos;) {
        place = &(*place)[std::string(path.substr(0, dot))];
        path.remove_prefix(dot + 1);
        if (!place->is_null() && !place->is_object()) break;
      }
      const std::string key(path);
      if ((!place->is_null() && !place->is_object()) || place->contains(key)) {
        table.refuse("columns", "of \"" + columns[k] + "\" twice", "each is there once");
      }
      (*place)[key] = cells[k];
    }
  }
  return objects;
}

Json to_json(const StudyResults& results) {
  StudyResults shortened = results;
  for (ResultEntry& result : shortened.results) {
    if (result.why_of.empty()) continue;
    result.why.clear();
    result.reasons.clear();
  }
  Json json = {{"format", 2}, {"study", "visibility"}};
  json.update(JsonWriter(shortened).json_of(shortened));
  return json;
}

StudyResults read_results(const std::string& file, const Json& json) {
  const JsonPart top(file, json);
  if (!json.is_object() || !json.contains("format") || !json.contains("study")) {
    top.refuse("", "is not the result of a study: it lacks \"format\" and \"study\"");
  }
  if (json["format"] != 2) top.refuse("format", json["format"].dump(), "this program reads 2");
  if (top.needed_text("study") != "visibility") {
    top.refuse("study", "\"" + top.text("study") + "\"", "reports are of study visibility");
  }
  StudyResults study;
  EntryNames names(study);
  JsonReader(top, names).read(top, study);
  check_together(top, study);
  take_reasons_over(study);
  return study;
}

std::vector<Timeline> timelines_of(const StudyResults& study) {
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, const ResultEntry*> results;
  std::set<std::pair<std::size_t, std::size_t>> judged;  // cameras and targets
  for (const ResultEntry& result : study.results) {
    results[{result.camera, result.target, result.condition}] = &result;
    judged.insert({result.camera, result.target});
  }
  std::vector<Timeline> lines;
  for (const auto& [camera, target] : judged) {
    const std::size_t scene = study.cameras[camera].scene, first = lines.size();
    for (std::size_t k = 0; k < study.conditions.size(); ++k) {
      const ConditionEntry& condition = study.conditions[k];
      if (condition.scene != scene || !(condition.position_deg || condition.time_s)) continue;
      auto line = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(),
                               [&](const Timeline& l) { return l.lamps == condition.lamps; });
      if (line == lines.end()) {
        line = lines.insert(lines.end(), {scene, study.cameras[camera].name, study.targets[target],
                                          condition.lamps});
      }
      const auto found = results.find({camera, target, k});
      const auto value = [&](Figure of) {
        return found == results.end() ? Number() : of(*found->second);
      };
      // What remains visible of a hidden target has a chance of its own, which is not the target's.
      const bool hidden =
          found != results.end() && found->second->sight.verdict == studies::Verdict::Hidden;
      const auto chance = [&](Figure of) { return hidden ? Number() : value(of); };
      line->utc.push_back(condition.utc);
      line->position_deg.push_back(condition.position_deg);
      line->time_s.push_back(condition.time_s);
      line->sun_share.push_back(condition.sun_share);
      line->detect.push_back(chance(chance_of<&Probability::detect>));
      line->recognise.push_back(chance(chance_of<&Probability::recognise>));
      line->identify.push_back(chance(chance_of<&Probability::identify>));
      line->luminance.push_back(value(sight_of<&Sight::luminance>));
      line->weber.push_back(value(sight_of<&Sight::weber>));
      line->verdict.push_back(found == results.end() ? std::nullopt
                                                     : std::optional(found->second->sight.verdict));
    }
  }
  std::erase_if(lines, [](const Timeline& line) { return line.detect.size() < 2; });
  return lines;
}

std::string results_csv(const StudyResults& study) {
  Json rows = Json::array();
  for (const ResultEntry& result : study.results) {
    const ConditionEntry& condition = study.conditions[result.condition];
    Json row = {{"scene", study.scenes[condition.scene].id},
                {"utc", condition.utc.empty() ? Json() : Json(condition.utc)},
                {"position_deg", to_json(condition.position_deg)},
                {"time_s", to_json(condition.time_s)},
                {"phase", condition.phase.empty() ? Json() : Json(condition.phase)},
                {"sun_share", to_json(condition.sun_share)},
                {"lamps", condition.lamps},
                {"camera", study.cameras[result.camera].name},
                {"target", study.targets[result.target]}};
    for (const CsvColumn& column : csv_columns) row[column.name] = column.of(result);
    rows.push_back(std::move(row));
  }
  return csv_of(rows);
}

std::string study_text(const StudyResults& study) {
  std::string text = fmt::format("{:<10} {:<20} {:<16} {:>13}  {}\n", "camera", "target", "lamps",
                                 "P(detect)", "verdicts; why not better, at worst");
  const std::vector<Line> lines = lines_of(study);
  const std::string* scene = nullptr;
  for (const Line& line : lines) {
    if (!line.scene.empty() && (scene == nullptr || *scene != line.scene)) {
      text += fmt::format("in {}:\n", line.scene);
    }
    scene = &line.scene;
    std::string verdicts;
    for (const auto& [verdict, count] : line.verdicts) {
      verdicts += fmt::format("{}{}{}", verdicts.empty() ? "" : ", ", word_of(verdict),
                              line.count > 1 ? fmt::format(" x{}", count) : "");
    }
    const std::string range = line.best - line.worst < 0.005
                                  ? fmt::format("{:.2f}", line.best)
                                  : fmt::format("{:.2f} to {:.2f}", line.worst, line.best);
    text += fmt::format("{:<10} {:<20} {:<16} {:>13}  {}{}\n", line.camera, line.target, line.lamps,
                        range, verdicts, line.why.empty() ? "" : "; " + line.why);
  }
  if (lines.empty()) text = "No object is a target: nothing was judged.\n";
  for (const AnswerEntry& answer : study.answers) {
    text += fmt::format("{}: {}\n", answer.wanted, answer.text);
  }
  for (const CameraEntry& camera : study.cameras) {
    const std::string in =
        study.scenes.size() > 1 ? " in " + scene_title(study, camera.scene) : std::string();
    text += fmt::format("camera {}{}: {}\n", camera.name, in, camera.error_text);
  }
  for (const std::string& note : black_back_notes(study)) text += note + "\n";
  return text;
}

std::vector<std::string> black_back_notes(const StudyResults& study) {
  struct Seen {
    std::size_t camera = 0, target = 0;
    int count = 0, of = 0;
    double share = 0.0;
  };
  std::vector<Seen> list;
  for (const ResultEntry& result : study.results) {
    if (!result.sight.black_back) continue;
    auto seen = std::find_if(list.begin(), list.end(), [&](const Seen& s) {
      return s.camera == result.camera && s.target == result.target;
    });
    if (seen == list.end()) seen = list.insert(list.end(), {result.camera, result.target});
    const double share = *result.sight.black_back;
    ++seen->of;
    seen->count += share >= studies::SightOptions{}.most_black_back ? 1 : 0;
    seen->share = std::max(seen->share, share);
  }
  std::vector<std::string> notes;
  for (const Seen& seen : list) {
    if (seen.count == 0) continue;
    const CameraEntry& camera = study.cameras[seen.camera];
    notes.push_back(fmt::format(
        "Camera {}{} looks at the black back of {} ({:.0f} % of what it sees, in {} of {} "
        "results): its surface has one side. How its real back looks is not known, so it counts "
        "as doubtful at best; turn it round, or give its material two_sided = true.",
        camera.name, study.scenes.size() > 1 ? " in " + scene_title(study, camera.scene) : "",
        study.targets[seen.target], 100.0 * seen.share, seen.count, seen.of));
  }
  return notes;
}

}  // namespace earthshine::app
