// SPDX-License-Identifier: Apache-2.0
// Converts structs with a list of fields (describe, in results_fields.h) to JSON and back.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/study/json_part.h"
#include "app/study/results_fields.h"

namespace earthshine::app {

template <class Value>
inline constexpr bool is_list = false;
template <class Value>
inline constexpr bool is_list<std::vector<Value>> = true;
template <class Value>
inline constexpr bool is_optional = false;
template <class Value>
inline constexpr bool is_optional<std::optional<Value>> = true;

// A number rounded as in study.json.
[[nodiscard]] Json with_four_digits(double value);

class JsonWriter {
 public:
  // Form of struct members: nested objects, or, in a table row, flat cells ("signal.mean") that are
  // always present, with numbers of four digits.
  enum class Form { Nested, Row };
  // study: supplies the names of entries; must outlive this.
  explicit JsonWriter(const StudyResults& study, Form form = Form::Nested)
      : study_(study), form_(form) {}

  template <class Value>
  [[nodiscard]] Json json_of(const Value& value) const {
    if constexpr (is_optional<Value>) {
      return value ? json_of(*value) : Json();
    } else if constexpr (is_list<Value>) {
      Json list = Json::array();
      for (const auto& one : value) list.push_back(json_of(one));
      return list;
    } else if constexpr (std::is_same_v<Value, Rgb>) {
      return value.r == value.g && value.g == value.b ? Json(value.r) : to_json(value);
    } else if constexpr (std::is_same_v<Value, studies::Arc>) {
      return Json::array({value.first, value.second});
    } else if constexpr (std::is_floating_point_v<Value>) {
      return form_ == Form::Row ? with_four_digits(value) : Json(value);
    } else if constexpr (std::is_constructible_v<Json, Value>) {
      return value;
    } else {
      JsonWriter inner(study_, form_);
      describe(inner, value);
      return inner.json_;
    }
  }

  template <class Value>
  void operator()(const char* key, const Value& value) {
    json_[key] = json_of(value);
  }
  // A part of a struct that may be missing.
  template <class Struct>
  void part(const char* key, const std::optional<Struct>& value) {
    if (form_ == Form::Nested) return (*this)(key, value);
    const Json members = json_of(value.value_or(Struct{}));
    for (const auto& [name, cell] : members.items()) {
      json_[std::string(key) + "." + name] = value ? cell : Json();
    }
  }
  // {"columns": [...], "rows": [[...], ...]}
  template <class Value>
  void table(const char* key, const std::vector<Value>& values) {
    Json columns = Json::array(), rows = Json::array();
    for (const Value& value : values) {
      const Json row = JsonWriter(study_, Form::Row).json_of(value);
      Json& cells = rows.emplace_back(Json::array());
      for (const auto& [name, cell] : row.items()) {
        if (rows.size() == 1) columns.push_back(name);
        cells.push_back(cell);
      }
    }
    json_[key] = {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
  }
  void or_null(const char* key, const std::string& text) {
    json_[key] = text.empty() ? Json() : Json(text);
  }
  template <class Value>
  void if_any(const char* key, const std::optional<Value>& value) {
    if (value) json_[key] = json_of(*value);
  }
  void if_any(const char* key, const std::string& text) {
    if (!text.empty()) json_[key] = text;
  }
  template <class Enum>
  void word(const char* key, Enum value, Enum) {
    json_[key] = std::string(word_of(value));
  }
  void one_of(const char* key, const std::string& text, std::initializer_list<const char*>) {
    or_null(key, text);
  }
  template <class Value>
  void list(const char* key, const std::vector<Value>& values) {
    json_[key] = json_of(values);
  }
  void entry(Named, const char* key, const std::string& name, std::size_t = 0) {
    json_[key] = name;
  }
  void names(Named, const char* key, const std::vector<std::string>& names) { json_[key] = names; }
  void at(Named what, const char* key, std::size_t number, std::size_t = 0) {
    json_[key] = name_of(study_, what, number);
  }
  void camera(const char* key, std::size_t number, std::size_t) { at(Named::Camera, key, number); }
  void shares(const char* key, const std::vector<GroupShare>& shares) {
    Json& object = json_[key] = Json::object();
    for (const GroupShare& share : shares) object[share.group] = json_of(share.value);
  }
  void light(const char* straight, const char* reflected,
             const std::vector<studies::LightShare>& light) {
    for (const char* key : {straight, reflected}) json_[key] = Json::object();
    for (const studies::LightShare& one : light) {
      json_[one.reflected ? reflected : straight][one.from] = json_of(one.share);
    }
  }
  void factors(const char* key, const std::vector<Factor>& factors) {
    Json& object = json_[key] = Json::object();
    for (const Factor& one : factors) object[one.group] = json_of(one.factor);
  }

 private:
  const StudyResults& study_;
  Form form_;
  Json json_ = Json::object();
};

// The rows of {"columns": [...], "rows": [[...], ...]} as objects: "signal.mean" becomes a member
// of "signal", which is null if all of its cells are.
[[nodiscard]] std::vector<Json> objects_of_rows(const JsonPart& table);

// Entries of a study that were read so far, by name; cameras also by scene.
class EntryNames {
 public:
  // study: being read; must outlive this.
  explicit EntryNames(const StudyResults& study) : study_(study) {}
  void add(const JsonPart& part, Named what, const char* key, const std::string& name,
           std::size_t scene);
  [[nodiscard]] std::size_t find(const JsonPart& part, Named what, const char* key,
                                 std::size_t scene) const;
  [[nodiscard]] std::size_t scene_of(std::size_t condition) const {
    return study_.conditions[condition].scene;
  }

 private:
  const StudyResults& study_;
  std::map<std::tuple<Named, std::size_t, std::string>, std::size_t> places_;
  std::map<Named, std::size_t> counts_;
};

// Missing and null members keep their defaults.
class JsonReader {
 public:
  // Both must outlive this.
  JsonReader(const JsonPart& part, EntryNames& names) : part_(part), names_(names) {}

  template <class Value>
  void operator()(const char* key, Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      value = part_.flag(key, value);
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value = part_.text(key);
    } else if constexpr (std::is_same_v<Value, double>) {
      value = part_.number(key).value_or(value);
    } else if constexpr (std::is_integral_v<Value>) {
      value = part_.count<Value>(key).value_or(value);
    } else if constexpr (std::is_same_v<Value, Json>) {
      value = part_.object(key).json();
    } else if constexpr (is_optional<Value>) {
      value.reset();
      if (part_.has(key)) (*this)(key, value.emplace());
      // Non-finite numbers count as missing.
      if constexpr (std::is_same_v<Value, Number>) value = part_.number(key);
    } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
      value = part_.texts(key);
    } else if constexpr (std::is_same_v<Value, std::vector<Number>>) {
      value = part_.numbers(key);
    } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
      for (const Number& one : part_.numbers(key)) value.push_back(one.value_or(NAN));
    } else if constexpr (std::is_same_v<Value, std::vector<studies::Arc>>) {
      for (const JsonPart& arc : part_.list(key)) value.push_back(arc.as_pair());
    } else if constexpr (is_list<Value>) {
      for (const JsonPart& one : part_.list(key)) read(one, value.emplace_back());
    } else {
      read(part_.object(key), value);
    }
  }
  void or_null(const char* key, std::string& text) { text = part_.text(key); }
  template <class Value>
  void if_any(const char* key, Value& value) {
    (*this)(key, value);
  }
  template <class Value>
  void if_any(const char* key, std::optional<std::optional<Value>>& value) {
    if (part_.json().contains(key)) (*this)(key, value.emplace());
  }
  template <class Struct>
  void part(const char* key, std::optional<Struct>& value) {
    (*this)(key, value);
  }
  template <class Value>
  void table(const char* key, std::vector<Value>& values) {
    const JsonPart table = part_.object(key);
    const std::vector<Json> rows = objects_of_rows(table);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      read(table.stands_for(fmt::format("rows[{}]", k), rows[k]), values.emplace_back());
    }
  }
  template <class Enum>
  void word(const char* key, Enum& value, Enum last) {
    const std::string text = part_.needed_text(key);
    std::string known;
    for (int k = 0; k <= static_cast<int>(last); ++k) {
      value = static_cast<Enum>(k);
      if (text == word_of(value)) return;
      known += (known.empty() ? "" : ", ") + std::string(word_of(value));
    }
    part_.refuse(key, "\"" + text + "\"", "it is one of " + known);
  }
  void one_of(const char* key, std::string& text, std::initializer_list<const char*> words);
  template <class Value>
  void list(const char* key, std::vector<Value>& values) {
    for (const JsonPart& one : part_.needed_list(key)) read(one, values.emplace_back());
  }
  void entry(Named what, const char* key, std::string& name, std::size_t scene = 0) {
    name = part_.needed_text(key);
    names_.add(part_, what, key, name, scene);
  }
  void names(Named what, const char* key, std::vector<std::string>& names) {
    for (const JsonPart& one : part_.needed_list(key)) {
      names.push_back(one.as_text());
      names_.add(one, what, "", names.back(), 0);
    }
  }
  void at(Named what, const char* key, std::size_t& number, std::size_t scene = 0) {
    number = names_.find(part_, what, key, scene);
  }
  void camera(const char* key, std::size_t& number, std::size_t condition) {
    at(Named::Camera, key, number, names_.scene_of(condition));
  }
  void shares(const char* key, std::vector<GroupShare>& shares) {
    const JsonPart object = part_.object(key);
    for (const auto& [group, value] : object.json().items()) {
      shares.push_back({group, object.number(group.c_str())});
    }
  }
  void light(const char* straight, const char* reflected, std::vector<studies::LightShare>& light) {
    for (const char* key : {straight, reflected}) {
      const JsonPart object = part_.object(key);
      for (const auto& [from, value] : object.json().items()) {
        light.push_back({from, key == reflected, object.number(from.c_str()).value_or(0.0)});
      }
    }
    std::stable_sort(light.begin(), light.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
  }
  void factors(const char* key, std::vector<Factor>& factors);

  // Reads a part itself.
  template <class Value>
  void read(const JsonPart& part, Value& value) const {
    if constexpr (is_list<Value>) {
      for (const JsonPart& one : part.entries()) read(one, value.emplace_back());
    } else {
      JsonReader inner(part, names_);
      describe(inner, value);
    }
  }

 private:
  const JsonPart& part_;
  EntryNames& names_;
};

// For structs that reference no entries of a study: stored results.
template <class Value>
[[nodiscard]] Json kept_json(const Value& value) {
  const StudyResults none;
  return JsonWriter(none).json_of(value);
}
template <class Value>
[[nodiscard]] Value read_kept(const Json& json) {
  const StudyResults none;
  EntryNames names(none);
  const JsonPart part("kept results", json);
  Value value;
  JsonReader(part, names).read(part, value);
  return value;
}

}  // namespace earthshine::app
