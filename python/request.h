// SPDX-License-Identifier: Apache-2.0
// Named arguments of a call from Python, and the lock of a call.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/json.h"
#include "base/parallel.h"

namespace earthshine::python {

// Values have the types that the package sends; possible user errors are checked here.
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
  // Throws base::Error (Input) unless there are `count` integers of at least `least`.
  [[nodiscard]] std::optional<std::vector<int>> whole_numbers(const char* key, std::size_t count,
                                                              int least = 0) const;
  // Quiet, with the seed.
  [[nodiscard]] app::Common common() const;
  [[nodiscard]] int threads() const;

 private:
  app::Json json_;
};

// Serialises calls from several Python threads: thread limits and stop requests are per process.
class CallLock {
 public:
  CallLock();
  explicit CallLock(const Request& request);

 private:
  std::unique_lock<std::mutex> lock_;
  base::ThreadLimit threads_;
};

// Throws Stopped if the call is asked to stop.
void leave_if_asked();

}  // namespace earthshine::python
