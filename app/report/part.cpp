// SPDX-License-Identifier: Apache-2.0
#include "app/report/part.h"

#include <cmath>

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

ReportPart::ReportPart(const ReportPart& parent, const std::string& step, const Json& json)
    : file_(parent.file_), place_(parent.place_), json_(&json) {
  if (!place_.empty() && step.front() != '[') place_ += '.';
  place_ += step;
}

void ReportPart::refuse(const std::string& key, const std::string& found,
                        const std::string& allowed) const {
  std::string place = place_;
  if (!place.empty() && !key.empty()) place += '.';
  place += key;
  throw base::Error(base::Blame::Input, file_, place.empty() ? found : place + " is " + found,
                    allowed, "Run the study again, which writes the file anew");
}

const Json& ReportPart::member(const char* key) const {
  static const Json nothing;
  if (!json_->is_object()) refuse("", kind_of(*json_), "an object is meant");
  const auto found = json_->find(key);
  return found == json_->end() ? nothing : *found;
}

std::optional<double> ReportPart::number(const char* key) const {
  const Json& value = member(key);
  if (value.is_null()) return std::nullopt;
  if (!value.is_number()) refuse(key, kind_of(value), "a number or null is meant");
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string ReportPart::text(const char* key) const {
  const Json& value = member(key);
  if (value.is_null()) return "";
  if (!value.is_string()) refuse(key, kind_of(value), "a text is meant");
  return value.get<std::string>();
}

std::string ReportPart::needed_text(const char* key) const {
  if (member(key).is_null()) refuse(key, "missing", "a text is meant");
  return text(key);
}

bool ReportPart::flag(const char* key, bool otherwise) const {
  const Json& value = member(key);
  if (value.is_null()) return otherwise;
  if (!value.is_boolean()) refuse(key, kind_of(value), "true or false is meant");
  return value.get<bool>();
}

ReportPart ReportPart::object(const char* key) const {
  static const Json empty = Json::object();
  const Json& value = member(key);
  if (value.is_null()) return {*this, key, empty};
  if (!value.is_object()) refuse(key, kind_of(value), "an object or null is meant");
  return {*this, key, value};
}

std::vector<ReportPart> ReportPart::list(const char* key) const {
  const Json& value = member(key);
  if (!value.is_null() && !value.is_array()) refuse(key, kind_of(value), "a list is meant");
  std::vector<ReportPart> parts;
  parts.reserve(value.size());
  for (std::size_t k = 0; k < value.size(); ++k) {
    parts.push_back({*this, std::string(key) + "[" + std::to_string(k) + "]", value[k]});
  }
  return parts;
}

std::vector<ReportPart> ReportPart::needed_list(const char* key) const {
  if (member(key).is_null()) refuse(key, "missing", "a list is meant");
  return list(key);
}

std::vector<std::optional<double>> ReportPart::numbers(const char* key) const {
  std::vector<std::optional<double>> values;
  for (const ReportPart& part : list(key)) {
    const Json& value = part.json();
    if (!value.is_null() && !value.is_number()) {
      part.refuse("", kind_of(value), "a number or null is meant");
    }
    const double number = value.is_null() ? NAN : value.get<double>();
    values.push_back(std::isfinite(number) ? std::optional(number) : std::nullopt);
  }
  return values;
}

std::vector<std::string> ReportPart::texts(const char* key) const {
  std::vector<std::string> values;
  for (const ReportPart& part : list(key)) values.push_back(part.as_text());
  return values;
}

std::string ReportPart::as_text() const {
  if (!json_->is_string()) refuse("", kind_of(*json_), "a text is meant");
  return json_->get<std::string>();
}

}  // namespace earthshine::app
