// SPDX-License-Identifier: Apache-2.0
// A part of a JSON file with its path, so that errors can name their place.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

class JsonPart {
 public:
  // `json` must outlive this and all parts taken from it.
  JsonPart(std::string file, const Json& json) : file_(std::move(file)), json_(&json) {}

  // Whether the member is present and not null.
  [[nodiscard]] bool has(const char* key) const { return !member(key).is_null(); }

  // Members. Missing members are null; null is nullopt, "" or an empty list, unless stated
  // otherwise. Any other type throws base::Error (Input).
  [[nodiscard]] std::optional<double> number(const char* key) const;  // never NaN
  template <class Whole>
  [[nodiscard]] std::optional<Whole> count(const char* key) const {  // at least 0
    const std::optional<double> value = number(key);
    // 2^53: all smaller integers are exact in double precision.
    constexpr double most =
        std::min(0x1p53, static_cast<double>(std::numeric_limits<Whole>::max()));
    if (value && !(*value >= 0.0 && *value <= most && *value == std::floor(*value))) {
      refuse(key, "no count", "a whole number from 0 on is meant");
    }
    return value ? std::optional(static_cast<Whole>(*value)) : std::nullopt;
  }
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] std::string needed_text(const char* key) const;  // throws if missing
  [[nodiscard]] bool flag(const char* key, bool otherwise) const;
  [[nodiscard]] JsonPart object(const char* key) const;  // empty if missing
  [[nodiscard]] std::vector<JsonPart> list(const char* key) const;
  [[nodiscard]] std::vector<JsonPart> needed_list(const char* key) const;
  [[nodiscard]] std::vector<std::optional<double>> numbers(const char* key) const;
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;

  // The value of this part.
  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] std::pair<double, double> as_pair() const;
  [[nodiscard]] std::vector<JsonPart> entries() const;
  [[nodiscard]] const Json& json() const { return *json_; }
  // `json` as if it were at this path below the part; must outlive the result.
  [[nodiscard]] JsonPart stands_for(const std::string& step, const Json& json) const {
    return {*this, step, json};
  }

  // Throws base::Error (Input) that names the member, or this part if `key` is "".
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& allowed = {}) const;

 private:
  JsonPart(const JsonPart& parent, const std::string& step, const Json& json);
  [[nodiscard]] const Json& member(const char* key) const;

  std::string file_, place_;
  const Json* json_;
};

}  // namespace earthshine::app
