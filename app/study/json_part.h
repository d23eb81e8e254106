// SPDX-License-Identifier: Apache-2.0
// A part of a JSON file that knows its place in it, so that whatever is wrong can be named.
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
  // `json` must outlive this and what is taken from it.
  JsonPart(std::string file, const Json& json) : file_(std::move(file)), json_(&json) {}

  // Whether the member is there and not null.
  [[nodiscard]] bool has(const char* key) const { return !member(key).is_null(); }

  // Members. What is missing is null; null is nullopt, "" or an empty list, unless said otherwise.
  // Anything of another type throws base::Error (Input).
  [[nodiscard]] std::optional<double> number(const char* key) const;  // never NaN
  template <class Whole>
  [[nodiscard]] std::optional<Whole> count(const char* key) const {  // from 0 on
    const std::optional<double> value = number(key);
    // 2^53: up to there each whole number is one of double precision.
    constexpr double most =
        std::min(0x1p53, static_cast<double>(std::numeric_limits<Whole>::max()));
    if (value && !(*value >= 0.0 && *value <= most && *value == std::floor(*value))) {
      refuse(key, "no count", "a whole number from 0 on is meant");
    }
    return value ? std::optional(static_cast<Whole>(*value)) : std::nullopt;
  }
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] std::string needed_text(const char* key) const;  // throws where there is none
  [[nodiscard]] bool flag(const char* key, bool otherwise) const;
  [[nodiscard]] JsonPart object(const char* key) const;  // an empty one where there is none
  [[nodiscard]] std::vector<JsonPart> list(const char* key) const;
  [[nodiscard]] std::vector<JsonPart> needed_list(const char* key) const;
  [[nodiscard]] std::vector<std::optional<double>> numbers(const char* key) const;
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;

  // This part itself.
  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] std::pair<double, double> as_pair() const;
  [[nodiscard]] std::vector<JsonPart> entries() const;
  [[nodiscard]] const Json& json() const { return *json_; }
  // `json` as if it stood at this step from here; it must outlive the part.
  [[nodiscard]] JsonPart stands_for(const std::string& step, const Json& json) const {
    return {*this, step, json};
  }

  // Throws base::Error (Input) that names the member, or this part where `key` is "".
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& allowed = {}) const;

 private:
  JsonPart(const JsonPart& parent, const std::string& step, const Json& json);
  [[nodiscard]] const Json& member(const char* key) const;

  std::string file_, place_;
  const Json* json_;
};

}  // namespace earthshine::app
