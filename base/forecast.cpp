// SPDX-License-Identifier: Apache-2.0
#include "base/forecast.h"

#include <algorithm>

namespace earthshine::base {
namespace {

constexpr double least_s = 1e-3;
// A stage past its expected time, without reports or with more work than they knew of, is taken to
// be halfway.
constexpr double late = 2.0;
// Share of a stage from which on its reports alone predict it: the first ones are rough.
constexpr double trusted = 0.2;
// The end is shown by the result.
constexpr double most_shown = 0.99;

}  // namespace

void Forecast::expect(const Stage& stage) { to_come_.push_back(stage); }

void Forecast::drop(const std::string& kind) {
  const auto found = std::find_if(to_come_.begin(), to_come_.end(),
                                  [&](const Stage& stage) { return stage.kind == kind; });
  if (found != to_come_.end()) to_come_.erase(found);
}

void Forecast::drop_all() { to_come_.clear(); }

void Forecast::begin(const Stage& stage, double now) {
  end(now);
  drop(stage.kind);
  current_ = stage;
  under_way_ = true;
  began_ = now;
  done_ = total_ = 0;
}

void Forecast::advance(std::size_t done, std::size_t total) {
  if (!under_way_) return;
  done_ = std::min(done, total);
  total_ = total;
}

void Forecast::end(double now) {
  if (!under_way_) return;
  Measured& measured = measured_[current_.kind];
  measured.seconds += now - began_;
  measured.expected += current_.seconds;
  under_way_ = false;
}

double Forecast::expected(const Stage& stage, double slowdown) const {
  if (stage.kind.empty()) return stage.seconds;
  const auto found = measured_.find(stage.kind);
  if (found == measured_.end()) return stage.seconds * slowdown;
  return stage.seconds * found->second.seconds / std::max(least_s, found->second.expected);
}

double Forecast::seconds_of_current(double now, double slowdown) const {
  const double gone = std::max(least_s, now - began_);
  const double seconds = std::max(expected(current_, slowdown), late * gone);
  if (total_ <= 1 || done_ == 0 || done_ == total_) return seconds;
  const double done = static_cast<double>(done_) / static_cast<double>(total_);
  const double trust = std::min(1.0, done / trusted);
  return trust * gone / done + (1.0 - trust) * seconds;
}

Forecast::State Forecast::at(double now, double slowdown, double most) {
  double left = 0.0;
  if (under_way_) left = std::max(0.0, seconds_of_current(now, slowdown) - (now - began_));
  for (const Stage& stage : to_come_) left += expected(stage, slowdown);
  left = std::min(left, most);
  const double share = now / std::max(least_s, now + left);
  shown_ = std::clamp(share, shown_, std::max(shown_, most_shown));
  return {shown_, left};
}

}  // namespace earthshine::base
