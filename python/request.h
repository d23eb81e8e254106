// SPDX-License-Identifier: Apache-2.0
// A call's named arguments as Python sends them, and the turn that the call takes.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/json.h"
#include "base/parallel.h"

namespace earthshine::python {

// Values are of the kinds that the package sends; what a user may get wrong is checked here.
class Request {
 public:
  explicit Request(const std::string& text) : json_(app::Json::parse(text)) {}

  [[nodiscard]] bool has(const char* key) const {
    return json_.contains(key) && !json_[key].is_null();
  }
  [[nodiscard]] bool flag(const char* key) const { return has(key) && json_[key].get<bool>(); }
  [[nodiscard]] std::optional<double> number(const char* key) const;
  [[nodiscard]] std::string word(const char* key, const std::string& otherwise) const;
  [[nodiscard]] std::vector<std::string> words(const char* key) const;
  // Throws base::Error (Input) where there are not `count` whole numbers of 0 and more.
  [[nodiscard]] std::optional<std::vector<int>> whole_numbers(const char* key,
                                                              std::size_t count) const;
  [[nodiscard]] std::uint64_t seed() const;
  [[nodiscard]] int threads() const;

 private:
  app::Json json_;
};

// Calls from several Python threads take turns: limits of threads and requests to stop are the
// process's.
class Turn {
 public:
  Turn();
  explicit Turn(const Request& request);

 private:
  std::unique_lock<std::mutex> lock_;
  base::ThreadLimit threads_;
};

// Throws Stopped where the call is asked to end.
void leave_if_asked();

}  // namespace earthshine::python
