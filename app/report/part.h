// SPDX-License-Identifier: Apache-2.0
// A part of study.json that knows its place in it, so that whatever is wrong can be named.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command.h"

namespace earthshine::app {

class ReportPart {
 public:
  // `json` must outlive this and what is taken from it.
  ReportPart(std::string file, const Json& json) : file_(std::move(file)), json_(&json) {}

  // Members. What is missing is null; null is nullopt, "" or an empty list, unless said otherwise.
  // Anything of another type throws base::Error (Input).
  [[nodiscard]] std::optional<double> number(const char* key) const;  // never NaN
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] std::string needed_text(const char* key) const;  // throws where there is none
  [[nodiscard]] bool flag(const char* key, bool otherwise) const;
  [[nodiscard]] ReportPart object(const char* key) const;  // an empty one where there is none
  [[nodiscard]] std::vector<ReportPart> list(const char* key) const;
  [[nodiscard]] std::vector<ReportPart> needed_list(const char* key) const;
  [[nodiscard]] std::vector<std::optional<double>> numbers(const char* key) const;
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;

  // This part itself as a text.
  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] const Json& json() const { return *json_; }

  // Throws base::Error (Input) that names the member, or this part where `key` is "".
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& allowed = {}) const;

 private:
  ReportPart(const ReportPart& parent, const std::string& step, const Json& json);
  [[nodiscard]] const Json& member(const char* key) const;

  std::string file_, place_;
  const Json* json_;
};

}  // namespace earthshine::app
