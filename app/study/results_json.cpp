// SPDX-License-Identifier: Apache-2.0
#include "app/study/results_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "app/study/json_fields.h"

namespace earthshine::app {

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

// What each entry for itself cannot know to be wrong.
void check_together(const JsonPart& top, const StudyResults& study) {
  std::set<std::tuple<std::size_t, std::size_t, std::size_t>> seen;
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    const ResultEntry& result = study.results[k];
    if (seen.insert({result.condition, result.camera, result.target}).second) continue;
    top.refuse(fmt::format("results[{}]", k), "there once more",
               "each condition, camera and target has one result");
  }
}

// What is not there is unknown everywhere.
void even_out(const JsonPart& top, std::vector<Timeline>& timelines) {
  for (std::size_t k = 0; k < timelines.size(); ++k) {
    Timeline& line = timelines[k];
    const std::size_t count = std::max(line.position_deg.size(), line.time_s.size());
    for (std::vector<Number>* series :
         {&line.position_deg, &line.time_s, &line.sun_share, &line.detect, &line.recognise,
          &line.identify, &line.luminance, &line.weber}) {
      if (series->empty()) series->resize(count);
      if (series->size() == count) continue;
      top.refuse(fmt::format("timelines[{}]", k), "uneven", "its lists have the same length");
    }
  }
}

}  // namespace

Json to_json(const StudyResults& results) {
  Json json = {{"format", 1}, {"study", "visibility"}};
  json.update(JsonWriter(results).json_of(results));
  return json;
}

StudyResults read_results(const std::string& file, const Json& json) {
  const JsonPart top(file, json);
  if (!json.is_object() || !json.contains("format") || !json.contains("study")) {
    top.refuse("", "is not the result of a study: it lacks \"format\" and \"study\"");
  }
  if (json["format"] != 1) top.refuse("format", json["format"].dump(), "this program reads 1");
  if (top.needed_text("study") != "visibility") {
    top.refuse("study", "\"" + top.text("study") + "\"", "reports are of study visibility");
  }
  StudyResults study;
  EntryNames names(study);
  JsonReader(top, names).read(top, study);
  check_together(top, study);
  even_out(top, study.timelines);
  return study;
}

}  // namespace earthshine::app
