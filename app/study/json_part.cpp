// SPDX-License-Identifier: Apache-2.0
#include "app/study/json_part.h"

#include "base/error.h"

namespace earthshine::app {
namespace {

std::string kind_of(const Json& json) {
  if (json.is_null()) return "missing";
  if (json.is_string()) return "a text";
  if (json.is_number()) return "a number";
  if (json.is_boolean()) return "true or false";
  return json.is_array() ? "a list" : "an object";
}

}  // namespace

JsonPart::JsonPart(const JsonPart& parent, const std::string& step, const Json& json)
    : file_(parent.file_), place_(parent.place_), json_(&json) {
  if (!place_.empty() && step.front() != '[') place_ += '.';
  place_ += step;
}

void JsonPart::refuse(const std::string& key, const std::string& found,
                      const std::string& allowed) const {
  std::string place = place_;
  if (!place.empty() && !key.empty()) place += '.';
  place += key;
  throw base::Error(base::Blame::Input, file_, place.empty() ? found : place + " is " + found,
                    allowed, "Run the study again, which writes the file anew");
}

const Json& JsonPart::member(const char* key) const {
  static const Json nothing;
  if (!json_->is_object()) refuse("", kind_of(*json_), "an object is meant");
  const auto found = json_->find(key);
  return found == json_->end() ? nothing : *found;
}

std::optional<double> JsonPart::number(const char* key) const {
  const Json& value = member(key);
  if (value.is_null()) return std::nullopt;
  if (!value.is_number()) refuse(key, kind_of(value), "a number or null is meant");
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string JsonPart::text(const char* key) const {
  const Json& value = member(key);
  if (value.is_null()) return "";
  if (!value.is_string()) refuse(key, kind_of(value), "a text is meant");
  return value.get<std::string>();
}

std::string JsonPart::needed_text(const char* key) const {
  if (member(key).is_null()) refuse(key, "missing", "a text is meant");
  return text(key);
}

bool JsonPart::flag(const char* key, bool otherwise) const {
  const Json& value = member(key);
  if (value.is_null()) return otherwise;
  if (!value.is_boolean()) refuse(key, kind_of(value), "true or false is meant");
  return value.get<bool>();
}

JsonPart JsonPart::object(const char* key) const {
  static const Json empty = Json::object();
  const Json& value = member(key);
  if (value.is_null()) return {*this, key, empty};
  if (!value.is_object()) refuse(key, kind_of(value), "an object or null is meant");
  return {*this, key, value};
}

std::vector<JsonPart> JsonPart::list(const char* key) const {
  const Json& value = member(key);
  return value.is_null() ? std::vector<JsonPart>() : JsonPart(*this, key, value).entries();
}

std::vector<JsonPart> JsonPart::needed_list(const char* key) const {
  if (member(key).is_null()) refuse(key, "missing", "a list is meant");
  return list(key);
}

std::vector<std::optional<double>> JsonPart::numbers(const char* key) const {
  std::vector<std::optional<double>> values;
  for (const JsonPart& part : list(key)) {
    const Json& value = part.json();
    if (!value.is_null() && !value.is_number()) {
      part.refuse("", kind_of(value), "a number or null is meant");
    }
    const double number = value.is_null() ? NAN : value.get<double>();
    values.push_back(std::isfinite(number) ? std::optional(number) : std::nullopt);
  }
  return values;
}

std::vector<std::string> JsonPart::texts(const char* key) const {
  std::vector<std::string> values;
  for (const JsonPart& part : list(key)) values.push_back(part.as_text());
  return values;
}

std::string JsonPart::as_text() const {
  if (!json_->is_string()) refuse("", kind_of(*json_), "a text is meant");
  return json_->get<std::string>();
}

std::pair<double, double> JsonPart::as_pair() const {
  const Json& ends = *json_;
  if (!ends.is_array() || ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number()) {
    refuse("", "not a pair", "a list of two numbers is meant");
  }
  return {ends[0].get<double>(), ends[1].get<double>()};
}

std::vector<JsonPart> JsonPart::entries() const {
  if (!json_->is_array()) refuse("", kind_of(*json_), "a list is meant");
  std::vector<JsonPart> parts;
  parts.reserve(json_->size());
  for (std::size_t k = 0; k < json_->size(); ++k) {
    parts.push_back({*this, "[" + std::to_string(k) + "]", (*json_)[k]});
  }
  return parts;
}

}  // namespace earthshine::app
