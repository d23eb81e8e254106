// SPDX-License-Identifier: Apache-2.0
#include "app/report/data.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "app/report/part.h"

namespace earthshine::app {
namespace {

// Entries by name, and the complaint where one is not there or is there twice.
template <class Key>
class Index {
 public:
  void add(const ReportPart& part, const char* key, const std::string& shown, const Key& entry) {
    if (!places_.emplace(entry, places_.size()).second) {
      part.refuse(key, "\"" + shown + "\" once more", "each is there once");
    }
  }
  [[nodiscard]] std::size_t find(const ReportPart& part, const char* key, const std::string& shown,
                                 const Key& entry, const char* list) const {
    const auto found = places_.find(entry);
    if (found == places_.end()) {
      part.refuse(key, "\"" + shown + "\"", "it is one of the study's " + std::string(list));
    }
    return found->second;
  }

 private:
  std::map<Key, std::size_t> places_;
};

using CameraKey = std::pair<std::size_t, std::string>;
struct Names {
  Index<std::string> scenes, targets, conditions;
  Index<CameraKey> cameras;
};

void read_scenes(const ReportPart& top, StudyResults& study, Names& names) {
  for (const ReportPart& part : top.needed_list("scenes")) {
    study.scenes.push_back({part.needed_text("id"), part.text("name"), part.text("path")});
    names.scenes.add(part, "id", study.scenes.back().id, study.scenes.back().id);
  }
}

std::size_t scene_of(const ReportPart& part, const Names& names) {
  const std::string id = part.needed_text("scene");
  return names.scenes.find(part, "scene", id, id, "scenes");
}

void read_cameras(const ReportPart& top, StudyResults& study, Names& names) {
  for (const ReportPart& part : top.needed_list("cameras")) {
    CameraEntry camera{scene_of(part, names),
                       part.needed_text("name"),
                       part.text("cctv"),
                       part.text("iris"),
                       part.text("error_text"),
                       part.number("columns"),
                       part.number("rows"),
                       part.number("fov_deg"),
                       part.number("relative_noise"),
                       part.number("render_seconds")};
    names.cameras.add(part, "name", camera.name, CameraKey{camera.scene, camera.name});
    study.cameras.push_back(std::move(camera));
  }
}

void read_targets(const ReportPart& top, StudyResults& study, Names& names) {
  for (const ReportPart& part : top.needed_list("targets")) {
    study.targets.push_back(part.as_text());
    names.targets.add(part, "", study.targets.back(), study.targets.back());
  }
}

void read_conditions(const ReportPart& top, StudyResults& study, Names& names) {
  for (const ReportPart& part : top.needed_list("conditions")) {
    ConditionEntry condition{part.needed_text("id"),     part.text("name"),
                             part.text("lamps"),         part.text("phase"),
                             scene_of(part, names),      part.number("position_deg"),
                             part.number("time_s"),      part.number("sun_share"),
                             part.number("earth_error"), {}};
    static const std::set<std::string> phases = {"", "day", "penumbra", "eclipse"};
    if (phases.count(condition.phase) == 0) {
      part.refuse("phase", "\"" + condition.phase + "\"", "it is day, penumbra, eclipse or null");
    }
    const ReportPart factors = part.object("factors");
    for (const auto& [group, value] : factors.json().items()) {
      condition.factors.push_back({group, factors.number(group.c_str())});
    }
    names.conditions.add(part, "id", condition.id, condition.id);
    study.conditions.push_back(std::move(condition));
  }
}

std::vector<GroupShare> shares_of(const ReportPart& part, const char* key, const char* value) {
  std::vector<GroupShare> shares;
  for (const ReportPart& share : part.list(key)) {
    shares.push_back({share.text("group"), share.number(value)});
  }
  return shares;
}

Verdict verdict_of(const ReportPart& part) {
  const std::string key = part.needed_text("verdict");
  std::string known;
  for (std::size_t k = 0; k < verdict_words.size(); ++k) {
    if (key == verdict_words[k].key) return static_cast<Verdict>(k);
    known += (known.empty() ? "" : ", ") + std::string(verdict_words[k].key);
  }
  part.refuse("verdict", "\"" + key + "\"", "verdicts are " + known);
}

template <std::size_t count>
std::array<Number, count> figures_of(const ReportPart& part,
                                     const std::array<FigureColumn, count>& columns) {
  std::array<Number, count> figures;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string inside = columns[k].part;
    const std::size_t dot = inside.find('.');
    if (inside.empty()) {
      figures[k] = part.number(columns[k].key);
    } else if (dot == std::string::npos) {
      figures[k] = part.object(inside.c_str()).number(columns[k].key);
    } else {
      const ReportPart outer = part.object(inside.substr(0, dot).c_str());
      figures[k] = outer.object(inside.substr(dot + 1).c_str()).number(columns[k].key);
    }
  }
  return figures;
}

void read_result_list(const ReportPart& top, StudyResults& study, const Names& names) {
  std::set<std::tuple<std::size_t, std::size_t, std::size_t>> seen;
  for (const ReportPart& part : top.needed_list("results")) {
    ResultEntry result{};
    const std::string condition = part.needed_text("condition");
    const std::string camera = part.needed_text("camera"), target = part.needed_text("target");
    result.condition = names.conditions.find(part, "condition", condition, condition, "conditions");
    const CameraKey key{study.conditions[result.condition].scene, camera};
    result.camera = names.cameras.find(part, "camera", camera, key, "cameras of that scene");
    result.target = names.targets.find(part, "target", target, target, "targets");
    if (!seen.insert({result.condition, result.camera, result.target}).second) {
      part.refuse("", "there once more", "each condition, camera and target has one result");
    }
    result.verdict = verdict_of(part);
    result.sight = figures_of(part, sight_columns);
    result.signal = figures_of(part, signal_columns);
    result.lit_by = shares_of(part, "lit_by", "share");
    result.light_by = shares_of(part, "light_by", "luminance");
    for (const ReportPart& from : part.list("light_from")) {
      result.light_from.push_back(
          {(from.flag("reflected", false) ? "by way of " : "") + from.text("from"),
           from.number("share")});
    }
    result.cut_by_frame = part.flag("cut_by_frame", false);
    result.why = part.text("why");
    for (const ReportPart& reason : part.list("reasons")) {
      result.reasons.push_back({reason.text("cause"), reason.text("by"), reason.text("text"),
                                reason.number("share"), reason.number("probability_without")});
    }
    study.results.push_back(std::move(result));
  }
}

void read_timelines(const ReportPart& top, StudyResults& study, const Names& names) {
  for (const ReportPart& part : top.list("timelines")) {
    Timeline line{study.scenes[scene_of(part, names)].name,
                  part.text("camera"),
                  part.text("target"),
                  part.text("lamps"),
                  part.numbers("position_deg"),
                  part.numbers("time_s"),
                  part.numbers("sun_share"),
                  part.numbers("detect"),
                  part.numbers("recognise"),
                  part.numbers("identify"),
                  part.numbers("luminance"),
                  part.numbers("weber")};
    const std::size_t count = std::max(line.position_deg.size(), line.time_s.size());
    for (std::vector<Number>* series :
         {&line.position_deg, &line.time_s, &line.sun_share, &line.detect, &line.recognise,
          &line.identify, &line.luminance, &line.weber}) {
      if (series->empty()) series->resize(count);  // what is not there is unknown everywhere
      if (series->size() != count) part.refuse("", "uneven", "its lists have the same length");
    }
    study.timelines.push_back(std::move(line));
  }
}

void read_answers(const ReportPart& top, StudyResults& study) {
  for (const ReportPart& part : top.list("answers")) {
    AnswerEntry answer{part.text("wanted"),         part.text("target"),
                       part.text("text"),           part.text("camera"),
                       part.text("iris"),           part.text("lamps"),
                       part.flag("found", false),   part.number("least"),
                       part.number("least_factor"), {}};
    for (const ReportPart& arc : part.list("arcs_deg")) {
      const Json& ends = arc.json();
      if (!ends.is_array() || ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number()) {
        arc.refuse("", "not an arc", "an arc is a list of two numbers");
      }
      answer.arcs_deg.emplace_back(ends[0].get<double>(), ends[1].get<double>());
    }
    study.answers.push_back(std::move(answer));
  }
}

PictureEntry picture_of(const ReportPart& part) {
  return {part.needed_text("file"), part.text("caption")};
}

void read_pictures(const ReportPart& top, StudyResults& study) {
  for (const ReportPart& part : top.list("pairs")) {
    study.pairs.push_back(
        {part.text("title"), picture_of(part.object("left")), picture_of(part.object("right"))});
  }
  for (const ReportPart& part : top.list("figures")) study.figures.push_back(picture_of(part));
}

void read_thumbnails(const ReportPart& top, StudyResults& study, const Names& names) {
  for (const ReportPart& part : top.list("thumbnails")) {
    const std::string condition = part.needed_text("condition"),
                      camera = part.needed_text("camera");
    const std::size_t at =
        names.conditions.find(part, "condition", condition, condition, "conditions");
    const CameraKey key{study.conditions[at].scene, camera};
    study.thumbnails.push_back(
        {at, names.cameras.find(part, "camera", camera, key, "cameras of that scene"),
         part.needed_text("file"), part.text("monitor_file")});
  }
}

}  // namespace

StudyResults read_results(const std::string& file, const Json& json) {
  const ReportPart top(file, json);
  if (!json.is_object() || !json.contains("format") || !json.contains("study")) {
    top.refuse("", "is not the result of a study: it lacks \"format\" and \"study\"");
  }
  if (json["format"] != 1) top.refuse("format", json["format"].dump(), "this program reads 1");
  if (top.needed_text("study") != "visibility") {
    top.refuse("study", "\"" + top.text("study") + "\"", "reports are of study visibility");
  }
  StudyResults study{};
  Names names;
  study.name = top.text("name");
  study.version = top.text("version");
  study.complete = top.flag("complete", true);
  read_scenes(top, study, names);
  read_cameras(top, study, names);
  read_targets(top, study, names);
  read_conditions(top, study, names);
  read_result_list(top, study, names);
  read_timelines(top, study, names);
  read_answers(top, study);
  read_pictures(top, study);
  read_thumbnails(top, study, names);
  for (const ReportPart& part : top.list("costs")) {
    study.costs.push_back({part.text("stage"), part.number("seconds"), part.number("rays")});
  }
  study.notes = top.texts("notes");
  study.settings = top.object("settings").json();
  study.provenance = top.object("provenance").json();
  return study;
}

}  // namespace earthshine::app
