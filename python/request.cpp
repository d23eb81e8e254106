// SPDX-License-Identifier: Apache-2.0
#include "python/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "app/console.h"
#include "base/error.h"
#include "python/session.h"

namespace earthshine::python {
namespace {

[[noreturn]] void refuse(const char* key, const app::Json& found, const std::string& allowed) {
  throw base::Error(base::Blame::Input, key, found.dump() + " is not allowed", allowed);
}

std::mutex& call_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

std::optional<double> Request::number(const char* key) const {
  if (!has(key)) return std::nullopt;
  if (!json_[key].is_number()) refuse(key, json_[key], "allowed is a number");
  const auto value = json_[key].get<double>();
  if (std::string_view(key) == "error" && !(value > 0.0 && value <= 1.0)) {
    refuse(key, json_[key], "allowed is a number above 0 and at most 1");
  }
  if (!(value >= 0.0)) refuse(key, json_[key], "allowed is a number of 0 and more");
  return value;
}

std::string Request::word(const char* key, const std::string& otherwise) const {
  return has(key) ? json_[key].get<std::string>() : otherwise;
}

std::vector<std::string> Request::words(const char* key) const {
  return has(key) ? json_[key].get<std::vector<std::string>>() : std::vector<std::string>();
}

std::optional<std::vector<int>> Request::whole_numbers(const char* key, std::size_t count,
                                                       int least) const {
  if (!has(key)) return std::nullopt;
  const app::Json& list = json_[key];
  const auto fits = [least](const app::Json& one) {
    return one.is_number_integer() && one >= least && one <= 16384;
  };
  if (!list.is_array() || list.size() != count || !std::all_of(list.begin(), list.end(), fits)) {
    refuse(key, list, fmt::format("allowed are {} whole numbers from {} to 16384", count, least));
  }
  return list.get<std::vector<int>>();
}

app::Common Request::common() const {
  app::Common common;
  common.quiet = true;
  common.seed = 1;
  if (!has("seed")) return common;
  const app::Json& seed = json_["seed"];
  if (!seed.is_number_unsigned()) refuse("seed", seed, "allowed is a whole number of 0 and more");
  common.seed = seed.get<std::uint64_t>();
  return common;
}

int Request::threads() const {
  const double threads = number("threads").value_or(0.0);
  if (!(threads <= 4096.0)) refuse("threads", json_["threads"], "allowed is 0 to 4096");
  return static_cast<int>(threads);
}

CallLock::CallLock() : lock_(call_mutex()), threads_(0) {}

CallLock::CallLock(const Request& request) : lock_(call_mutex()), threads_(request.threads()) {}

void leave_if_asked() {
  if (app::Interrupt::asked()) throw Stopped();
}

}  // namespace earthshine::python
